# The clock's tree, then setup and hold at all corners.
source common.tcl
open_stage place
estimate_parasitics -placement
repair_clock_inverters
# The tool's own search ends at clusters of 7: four times the buffers for the same skew
clock_tree_synthesis -root_buf $clock_root -buf_list $clock_buffers -sink_clustering_enable \
  -sink_clustering_size 30 -sink_clustering_max_diameter 100
set_propagated_clock [all_clocks]
estimate_parasitics -placement
repair_clock_nets
legalize
shorten
estimate_parasitics -placement
repair_timing -setup -setup_margin $setup_margin
repair_loads
repair_timing -hold -hold_margin $hold_margin
legalize
write_db cts.odb
