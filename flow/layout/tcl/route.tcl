# Detailed routes along the global ones of `loads`. Of a large design the first iterations alone, which take most of the
# time: `mend` goes on from there, and a run that is killed then resumes there.
source common.tcl
open_stage loads
set_propagated_clock [all_clocks]
routing_layers
set nets [llength [[ord::get_db_block] getNets]]
route_in_detail {*}[expr {$nets > $large ? [list -droute_end_iter $first_iterations] : ""}]
write_db route.odb
