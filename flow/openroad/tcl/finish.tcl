# Extracted wires and what leaves: DEF, LEF, netlists.
source common.tcl
open_stage route typical
define_process_corner -ext_model_index 0 X
if {[llength [info commands set_extraction_rules_file]]} {
  set_extraction_rules_file $rcx_rules
  extract_parasitics
} else {
  extract_parasitics -ext_model_file $rcx_rules
}
write_spef $top.spef
write_def $top.def
write_abstract_lef $top.lef
write_verilog -remove_cells $fill $top.v
write_verilog -include_pwr_gnd $top.power.v
report_design_area
report_floating_nets -verbose
