# Slews, loads, setup and hold once more, with the parasitics of global routes.
source common.tcl
open_stage cts
set_propagated_clock [all_clocks]
routing_layers
estimate_parasitics -placement -spef_file placement.spef
buffer_slow_ports
global_route -allow_congestion -congestion_iterations $congestion_iterations
estimate_parasitics -global_routing
repair_loads
repair_timing -setup -setup_margin $setup_margin
# Setup takes buffers away and makes gates larger: their drivers have to bear it
repair_loads
repair_hold
legalize
optimize_mirroring
write_db repair.odb
