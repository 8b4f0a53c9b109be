# What leaves: DEF, LEF, netlists. Cells without a function are not in the netlist for checks and timing.
source common.tcl
open_stage route
write_def final.def
write_abstract_lef final.lef
write_verilog -remove_cells $unconnected final.v
write_verilog -include_pwr_gnd final.power.v
report_design_area
report_floating_nets -verbose
