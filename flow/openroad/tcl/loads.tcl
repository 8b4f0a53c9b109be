# Slews and loads once more, on global routes between the places as they are now: hold's buffers, legal places and swaps
# came after their last repair. In a process of its own, as `route`. Routes change with every cell, and that makes some
# nets longer by half: twice the margin is left.
source common.tcl
open_stage repair
set_propagated_clock [all_clocks]
routing_layers
global_route -allow_congestion -congestion_iterations 50
estimate_parasitics -global_routing
set load_margin [expr {2 * $load_margin}]
repair_loads
legalize
optimize_mirroring
write_db loads.odb
