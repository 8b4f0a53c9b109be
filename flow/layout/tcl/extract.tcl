# Extracted wires at the corner of parasitics that the environment's CORNER names.
source common.tcl
set wires $::env(CORNER)
open_stage mend
foreach path $rcx_rules($wires) {
  if {[file isfile $pdk_root/$path]} { set rules $pdk_root/$path; break }
}
puts "rules: $rules"
define_process_corner -ext_model_index 0 X
if {[llength [info commands set_extraction_rules_file]]} {
  set_extraction_rules_file $rules
  extract_parasitics
} else {
  extract_parasitics -ext_model_file $rules
}
write_spef $wires.spef
