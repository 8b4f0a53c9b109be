# The clock's tree, then setup and hold at all corners.
source common.tcl
open_stage place
estimate_parasitics -placement
repair_clock_inverters
# Of a netlist whose clock gates and buffers bear their registers the net of the port alone has a tree
set nets [expr {$clock eq "" ? "" : [list -clk_nets $clock]}]
# The tool's own search ends at clusters of 7: four times the buffers for the same skew
set clusters {-sink_clustering_enable -sink_clustering_size 30 -sink_clustering_max_diameter 100}
clock_tree_synthesis -root_buf $clock_root -buf_list $clock_buffers {*}$nets \
  {*}[expr {$careful ? "" : $clusters}]
set_propagated_clock [all_clocks]
estimate_parasitics -placement
repair_clock_nets
legalize
estimate_parasitics -placement
repair_timing -setup -setup_margin $setup_margin
repair_loads
repair_hold
legalize
shorten
check_room
write_db cts.odb
