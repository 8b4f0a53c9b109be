# Extracted wires and what leaves: DEF, LEF, netlists.
source common.tcl
open_stage route typical
foreach path $rcx_rules {
  if {[file isfile $pdk_root/$path]} { set rules $pdk_root/$path }
}
define_process_corner -ext_model_index 0 X
if {[llength [info commands set_extraction_rules_file]]} {
  set_extraction_rules_file $rules
  extract_parasitics
} else {
  extract_parasitics -ext_model_file $rules
}
write_spef $top.spef
write_def $top.def
write_abstract_lef $top.lef
write_verilog -remove_cells $fill $top.v
write_verilog -include_pwr_gnd $top.power.v
report_design_area
report_floating_nets -verbose
