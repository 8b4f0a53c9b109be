# Detailed routes along the global ones of `loads`.
source common.tcl
open_stage loads
set_propagated_clock [all_clocks]
routing_layers
route_in_detail
write_db route.odb
