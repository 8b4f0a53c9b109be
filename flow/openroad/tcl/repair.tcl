# Slews, loads, setup and hold once more, with the parasitics of global routes; a design that this leaves late stops.
source common.tcl
open_stage cts
set_propagated_clock [all_clocks]
routing_layers
estimate_parasitics -placement -spef_file placement.spef

proc estimate {args} {
  global_route -allow_congestion -congestion_iterations 50
  estimate_parasitics -global_routing {*}$args
}

estimate
repair_design
repair_timing -setup -setup_margin $setup_margin
repair_timing -hold -hold_margin $hold_margin
legalize
estimate -spef_file global.spef
foreach {name path} {setup max hold min} {
  set slack [worst_slack -$path]
  measured estimated_${name}_ns $slack
  if {$slack < 0} {
    error "$name slack is $slack ns after repair, with estimated wires: must be at least 0"
  }
}
write_db repair.odb
