# The clock's tree, then setup at the slow corner.
source common.tcl
open_stage place slow
estimate_parasitics -placement
repair_clock_inverters
clock_tree_synthesis -root_buf $clock_buffer -buf_list $clock_buffer -sink_clustering_enable
set_propagated_clock [all_clocks]
estimate_parasitics -placement
repair_clock_nets
detailed_placement
estimate_parasitics -placement
repair_timing -setup
detailed_placement
check_placement -verbose
write_db cts.odb
