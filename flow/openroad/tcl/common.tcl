# What every stage needs: the design's variables, and the database of the stage before at one corner.
source design.tcl

proc open_stage {before corner} {
  global liberty constraints signal_rc clock_rc dont_use
  read_liberty $liberty($corner)
  read_db $before.odb
  read_sdc $constraints
  set_wire_rc -signal -layer $signal_rc
  set_wire_rc -clock -layer $clock_rc
  set_dont_use $dont_use
}

proc routing_layers {} {
  global signal_layers clock_layers kept_free
  set_routing_layers -signal $signal_layers -clock $clock_layers
  set_global_routing_layer_adjustment $signal_layers $kept_free
}

# One line a figure, in a form that is ours: no report of the tool has to be understood.
proc measured {name value} {
  puts "TALBOT $name $value"
}
