# Slews and loads once more, on global routes between the places as they are now: hold's buffers, legal places and swaps
# came after their last repair. Twice the margin is left, since routes change with every cell. Larger cells and buffers
# of clocks move edges: hold comes last. What moves is routed again, and detailed routing gets these routes.
source common.tcl
open_stage repair
set_propagated_clock [all_clocks]
routing_layers

# Legal places, and routes of the cells that are new or moved. args: of estimate_parasitics
proc place_and_reroute {args} {
  global_route -start_incremental -allow_congestion
  legalize
  optimize_mirroring
  global_route -end_incremental -allow_congestion
  estimate_parasitics -global_routing {*}$args
}

global_route -allow_congestion -congestion_iterations $congestion_iterations
estimate_parasitics -global_routing
set load_margin [expr {2 * $load_margin}]
repair_loads
place_and_reroute
repair_timing -hold -hold_margin $hold_margin
place_and_reroute -spef_file global.spef

# A design that is late now stops here, before the hours of detailed routing
foreach {name path} {setup max hold min} {
  set slack [worst_slack -$path]
  measured estimated_${name}_ns $slack
  if {$slack < 0} {
    error "$name slack is $slack ns after repair, with estimated parasitics: must be at least 0"
  }
}
write_db loads.odb
