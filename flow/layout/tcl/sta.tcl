# Timing and power at every corner of the cells, with the wires extracted at the corner that CORNER names.
# OpenROAD wants the LEF for it, OpenSTA alone does not know any.
source common.tcl
set wires $::env(CORNER)
if {[llength [info commands read_lef]]} {
  read_lef $tech_lef
  read_lef $cell_lef
}
read_cells
read_verilog final.v
link_design $top
read_sdc $constraints
set_propagated_clock [all_clocks]
read_spef $wires.spef
foreach corner $corners {
  report_checks -path_delay max -fields {slew capacitance} -digits 4 -corner $corner
  report_checks -path_delay min -fields {slew capacitance} -digits 4 -corner $corner
  report_power -digits 6 -corner $corner
  measured wns_ns.$wires.$corner [worst_slack -max -corner $corner]
  measured whs_ns.$wires.$corner [worst_slack -min -corner $corner]
  write_sdf -corner $corner $wires.$corner.sdf
}
report_check_types -max_slew -max_capacitance -violators
foreach {name count} {slew max_slew_violation_count capacitance max_capacitance_violation_count} {
  if {[llength [info commands sta::$count]]} { measured ${name}_violations.$wires [sta::$count] }
}
