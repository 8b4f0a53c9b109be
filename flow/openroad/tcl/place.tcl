# Pins and cells, at the slow corner, where slews are worst.
source common.tcl
open_stage power slow
routing_layers
global_placement -density $density -pad_left 1 -pad_right 1 -skip_io
place_pins -hor_layers $pin_horizontal -ver_layers $pin_vertical
global_placement -routability_driven -density $density -pad_left 1 -pad_right 1
estimate_parasitics -placement
repair_design
repair_tie_fanout [join $low /]
repair_tie_fanout [join $high /]
detailed_placement
check_placement -verbose
write_db place.odb
