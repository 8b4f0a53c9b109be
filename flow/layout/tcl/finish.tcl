# What leaves: DEF, LEF, netlists. Cells without a function are not in the netlist for checks and timing.
source common.tcl
open_stage mend
write_def final.def
write_abstract_lef final.lef
write_verilog -remove_cells $unconnected final.v
write_verilog -include_pwr_gnd final.power.v
report_design_area
report_floating_nets -verbose

# Nets of several pins that have no route
set open 0
foreach net [[ord::get_db_block] getNets] {
  if {[$net getSigType] eq "POWER" || [$net getSigType] eq "GROUND"} { continue }
  if {[$net getWire] eq "NULL" && [$net getITermCount] + [$net getBTermCount] > 1} { incr open }
}
measured open_nets $open
