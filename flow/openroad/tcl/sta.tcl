# Timing and power at the corner named by the variable CORNER of the environment, with the extracted wires.
# OpenROAD wants the LEF for it, OpenSTA alone does not know any.
source common.tcl
set corner $::env(CORNER)
if {[llength [info commands read_lef]]} {
  read_lef $tech_lef
  read_lef $cell_lef
}
read_liberty $liberty($corner)
read_verilog $top.v
link_design $top
read_sdc $constraints
set_propagated_clock [all_clocks]
read_spef $top.spef
report_checks -path_delay max -fields {slew capacitance} -digits 4
report_checks -path_delay min -fields {slew capacitance} -digits 4
report_check_types -max_slew -max_capacitance -violators
report_power -digits 6
measured wns_ns.$corner [worst_slack -max]
measured whs_ns.$corner [worst_slack -min]
write_sdf $top.$corner.sdf
