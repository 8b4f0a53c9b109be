# What leaves: DEF, LEF, netlists. Cells without a function are not in the netlist for checks and timing.
source common.tcl
open_stage mend

# `thresholds` names the cells that become their twins. In a user's own OpenROAD, without extraction, none does
if {[file exists raised.txt]} {
  set file [open raised.txt]
  set raised [dict create]
  foreach name [split [string trim [read $file]] \n] { dict set raised $name 1 }
  close $file
  foreach inst [[ord::get_db_block] getInsts] {
    if {![dict exists $raised [plain_name [$inst getName]]]} { continue }
    $inst swapMaster [[ord::get_db] findMaster "[[$inst getMaster] getName]$twin"]
  }
}

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
