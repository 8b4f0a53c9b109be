# Slews and loads once more, on global routes between the places as they are now: hold's buffers, legal places and swaps
# came after their last repair. Twice the margin is left, since routes change with every cell. Larger cells and buffers
# of clocks move edges: hold comes last. What moves is routed again, and detailed routing gets these routes.
source common.tcl
open_stage repair
set_propagated_clock [all_clocks]
routing_layers

# Legal places, and routes of the cells that are new or moved; first a larger cell or a buffer for each driver that is
# beyond a limit on the present routes. New routes bring others beyond it: a few turns.
proc help_and_reroute {} {
  for {set turn 0; set helped 1} {$helped && $turn < 6} {incr turn} {
    global_route -start_incremental -allow_congestion
    set helped [help_drivers]
    legalize
    optimize_mirroring
    global_route -end_incremental -allow_congestion
    # Only estimates by placement clear what earlier edits of the netlist have marked: else repair_timing may end with EST-0104
    estimate_parasitics -placement
    estimate_parasitics -global_routing
  }
}

# repair_design estimates loads from the shortest wires: where a global route is longer, around congestion, a load stays
# beyond the driver's limit. Such a driver becomes the next larger of its kind; without one, a buffer halves the way, or
# drives the port.
proc help_drivers {} {
  set beyond [beyond_limits]
  set helped 0
  foreach net [[ord::get_db_block] getNets] {
    if {![is_beyond $net $beyond]} { continue }
    foreach driver [drivers $net] {
      set larger [larger_cell $driver]
      if {$larger ne "NULL"} {
        $driver swapMaster $larger
      } elseif {[$net getSigType] eq "SIGNAL"} {
        buffer_halfway $net
      } else { continue }
      incr helped
    }
  }
  return $helped
}

# The cell of twice the strength, NULL if there is none.
proc larger_cell {inst} {
  if {![regexp {^(.*[x_])(\d+)$} [[$inst getMaster] getName] - kind strength]} { return NULL }
  return [[ord::get_db] findMaster $kind[expr {2 * $strength}]]
}

proc buffer_halfway {net} {
  global clock_buffers
  set block [ord::get_db_block]
  set name halfway_[$net getName]
  while {[$block findInst $name] ne "NULL"} { append name _ }
  set inst [odb::dbInst_create $block [[ord::get_db] findMaster [lindex $clock_buffers 0]] $name]
  set second [odb::dbNet_create $block ${name}_net]
  set is_port [llength [$net getBTerms]]
  lassign [expr {$is_port ? [list $second $net] : [list $net $second]}] before after
  set corners {}
  foreach port [$net getBTerms] {
    set box [$port getBBox]
    lappend corners [list 1 [expr {([$box xMin] + [$box xMax]) / 2}] [expr {([$box yMin] + [$box yMax]) / 2}]]
  }
  foreach pin [$net getITerms] {
    lappend corners [list {*}[$pin getAvgXY]]
    if {$is_port ? [$pin isOutputSignal] : [$pin isInputSignal]} {
      $pin disconnect
      $pin connect $second
    }
  }
  foreach pin [$inst getITerms] {
    if {[$pin isInputSignal]} { $pin connect $before }
    if {[$pin isOutputSignal]} { $pin connect $after }
  }
  foreach axis {1 2} middle {x y} {
    set all [lsort -real [lmap at $corners { lindex $at $axis }]]
    set $middle [expr {round(([lindex $all 0] + [lindex $all end]) / 2)}]
  }
  $inst setLocation $x $y
  $inst setPlacementStatus PLACED
}

global_route -allow_congestion -congestion_iterations $congestion_iterations
estimate_parasitics -global_routing
set load_margin [expr {2 * $load_margin}]
repair_loads
# A slew that is just below its limit by these estimates is beyond it by the real wires
set longest_slew [sta::max_slew_check_limit]
set_max_transition [expr {0.9 * $longest_slew}] [current_design]
help_and_reroute
repair_hold
help_and_reroute
set_max_transition $longest_slew [current_design]
measured estimated_beyond [dict size [beyond_limits]]

# A design that is late now stops here, before the hours of detailed routing
foreach {name path} {setup max hold min} {
  set slack [worst_slack -$path]
  measured estimated_${name}_ns $slack
  if {$slack < 0} {
    stop "$name slack is $slack ns after repair, with estimated parasitics: must be at least 0"
  }
}
check_room
write_db loads.odb
