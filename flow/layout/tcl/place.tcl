# Pins and cells, by wire length and timing; slews and loads, then setup before the clock has its tree.
source common.tcl
open_stage power
routing_layers

# Ranges of the edges without pins: those of `closed`, and below straps. There a via to the rail is at the edge, and a
# pin a short that detailed_route does not see.
proc excluded {} {
  global clear straps closed
  set block [ord::get_db_block]
  set dbu [double [$block getDbUnitsPerMicron]]
  set ranges {}
  foreach edge $closed { lappend ranges -exclude $edge:* }
  foreach net [$block getNets] {
    if {$clear == 0 || [$net getSigType] ni {POWER GROUND}} { continue }
    foreach wire [$net getSWires] {
      foreach box [$wire getWires] {
        if {[$box isVia] || [[$box getTechLayer] getName] ne [lindex [lindex $straps end] 0]} { continue }
        set range [expr {[$box xMin] / $dbu - $clear}]-[expr {[$box xMax] / $dbu + $clear}]
        lappend ranges -exclude bottom:$range -exclude top:$range
      }
    }
  }
  return $ranges
}

proc double {value} { expr {double($value)} }

proc place_ports {} {
  global ports port_layer port_size pin_horizontal pin_vertical
  if {![llength $ports]} {
    place_pins -hor_layers $pin_horizontal -ver_layers $pin_vertical {*}[excluded]
  }
  foreach {name x y} $ports {
    place_pin -pin_name $name -layer $port_layer -location [list $x $y] -pin_size $port_size
  }
}

set room [list -pad_left $padding -pad_right $padding]
set least [gpl::get_global_placement_uniform_density {*}$room]
set density [expr {min(1.0, $least + (1 - $least) * $density_addon + 0.01)}]
measured placement_density $density
if {![llength $ports]} {
  global_placement -density $density {*}$room -skip_io
}
place_ports
global_placement -density $density {*}$room {*}[expr {$careful ? "" : "-timing_driven"}]
estimate_parasitics -placement
if {$output_buffer ne ""} {
  buffer_ports -outputs -buffer_cell $output_buffer
}
repair_loads
foreach cell [list $low $high] {
  if {[llength $cell]} { repair_tie_fanout [join $cell /] }
}
legalize
write_db place.odb
