# What every stage needs: the design's variables, the cells at all corners, and the database of the stage before.
source design.tcl

# A stage that crashed or made no progress is run again with `careful`: without what is known to do that
if {![info exists careful]} { set careful [expr {[info exists ::env(CAREFUL)] ? $::env(CAREFUL) : 0}] }

proc read_cells {} {
  global corners liberty
  define_corners {*}$corners
  foreach corner $corners {
    read_liberty -corner $corner $liberty($corner)
  }
}

proc read_netlist {} {
  global tech_lef cell_lef top constraints
  read_lef $tech_lef
  read_lef $cell_lef
  read_cells
  read_verilog netlist.v
  link_design $top
  read_sdc $constraints
}

proc open_stage {before} {
  global constraints dont_use
  read_cells
  read_db $before.odb
  read_sdc $constraints
  wires
  if {[llength $dont_use]} { set_dont_use $dont_use }
}

# Resistance and capacitance for estimates: the technology LEF has neither coupling nor the layers above and below.
proc wires {} {
  global layer_rc via_rc signal_rc clock_rc
  foreach {layer resistance capacitance} $layer_rc {
    set_layer_rc -layer $layer -resistance $resistance -capacitance $capacitance
  }
  foreach {via resistance} $via_rc {
    set_layer_rc -via $via -resistance $resistance
  }
  set_wire_rc -signal -layers $signal_rc
  set_wire_rc -clock -layers $clock_rc
}

proc routing_layers {} {
  global signal_layers clock_layers kept_free
  set_routing_layers -signal $signal_layers -clock $clock_layers
  foreach {layer share} $kept_free {
    set_global_routing_layer_adjustment $layer $share
  }
}

# Detailed routing, which goes on from the routes that there are. Its violations stay with the database. New cells are not
# on the supplies yet in every release, and their rails would be shorts to the router.
proc route_in_detail {} {
  global_connect
  detailed_route -output_drc route_drc.rpt -verbose 1
  set block [ord::get_db_block]
  set count [odb::dbIntProperty_find $block violations]
  if {$count ne "NULL"} { odb::dbProperty_destroy $count }
  odb::dbIntProperty_create $block violations [detailed_route_num_drvs]
}

# What the last detailed routing left.
proc violations {} {
  [odb::dbIntProperty_find [ord::get_db_block] violations] getValue
}

# Slews and loads, with a share of each limit left.
proc repair_loads {} {
  global load_margin
  repair_design -slew_margin $load_margin -cap_margin $load_margin
}

# Hold, with as many buffers as it takes: repair_timing ends at one buffer a cell, and inputs that go straight into
# registers need more. It ends by itself where the core is full.
proc repair_hold {} {
  global hold_margin
  while {[catch {repair_timing -hold -hold_margin $hold_margin -max_buffer_percent 100} why]} {
    if {![string match *RSZ-0060* $why]} { error $why $::errorInfo }
  }
}

# End the stage for a reason that is the design's: the flow tries another outline.
proc stop {why} {
  error "TALBOT stopped: $why"
}

# A core that repair has filled ends here: its detailed routing does not converge (amp_ctrl at 96 %: 9,910 violations after
# the first iteration, 10,172 after the second).
proc check_room {} {
  global fullest
  set share [rsz::utilization]
  if {$share > $fullest} {
    set percent [list [expr {100 * $share}] [expr {100 * $fullest}]]
    stop [format "cells fill %.1f %% of the core after repair: must be at most %g %%" {*}$percent]
  }
}

# A buffer at each output port that its driver alone moves too slowly: repair_design leaves a load that is the port's.
# With placement's estimates: the wheel crashes here when global routes are present.
proc buffer_slow_ports {} {
  global load_margin
  set longest [expr {(1 - 0.01 * $load_margin) * [sta::max_slew_check_limit]}]
  set fast {}
  foreach port [all_outputs] {
    if {[get_property $port slew_max] <= $longest} {
      lappend fast [[[ord::get_db_block] findBTerm [get_property $port full_name]] getNet]
    }
  }
  if {[llength $fast] == [llength [all_outputs]]} { return }
  foreach net $fast { $net setDoNotTouch 1 }
  buffer_ports -outputs
  foreach net $fast { $net setDoNotTouch 0 }
}

proc legalize {} {
  global padding
  set_placement_padding -global -left $padding -right $padding
  detailed_placement
  check_placement -verbose
}

# Shorter wires by swaps of neighbours and mirrored cells; releases before 2025 lack the swaps, and one of them crashes
# when slacks are asked for after these.
proc shorten {} {
  global careful
  foreach command [expr {$careful ? "optimize_mirroring" : "improve_placement optimize_mirroring"}] {
    if {[llength [info commands $command]]} { $command }
  }
  check_placement -verbose
}

# A pin's or an instance's name without the escapes of either database.
proc plain_name {name} { return [string map {\\ {}} $name] }

# Pins and ports beyond a limit of slew or load, as a dictionary.
proc beyond_limits {} {
  with_output_to_variable text { report_check_types -max_slew -max_capacitance -violators }
  set beyond [dict create]
  foreach line [split $text \n] {
    if {[string match *(VIOLATED)* $line]} { dict set beyond [plain_name [lindex [split [string trim $line]] 0]] 1 }
  }
  return $beyond
}

proc is_beyond {net beyond} {
  foreach pin [$net getITerms] {
    set name [plain_name [[$pin getInst] getName]]/[[$pin getMTerm] getName]
    if {[dict exists $beyond $name]} { return 1 }
  }
  foreach port [$net getBTerms] {
    if {[dict exists $beyond [plain_name [$port getName]]]} { return 1 }
  }
  return 0
}

proc drivers {net} {
  set found {}
  foreach pin [$net getITerms] {
    if {[$pin isOutputSignal]} { lappend found [$pin getInst] }
  }
  return $found
}

# One line a figure, in a form that is ours: no report of the tool has to be understood.
proc measured {name value} {
  puts "TALBOT $name $value"
  flush stdout
}
