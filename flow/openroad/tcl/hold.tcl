# Hold, at the fast corner.
source common.tcl
open_stage cts fast
set_propagated_clock [all_clocks]
estimate_parasitics -placement
repair_timing -hold
detailed_placement
check_placement -verbose
write_db hold.odb
