# Pins and cells, by wire length and timing; slews and loads, then setup before the clock has its tree.
source common.tcl
open_stage power
routing_layers
set room [list -pad_left $padding -pad_right $padding]
set least [gpl::get_global_placement_uniform_density {*}$room]
set density [expr {min(1.0, $least + (1 - $least) * $density_addon + 0.01)}]
measured placement_density $density
global_placement -density $density {*}$room -skip_io
place_pins -hor_layers $pin_horizontal -ver_layers $pin_vertical
global_placement -density $density {*}$room -timing_driven
estimate_parasitics -placement
# A load of the design's outside is a buffer's: repair puts none before a port, and a gate alone cannot drive it
buffer_ports -outputs -buffer_cell $output_buffer
repair_loads
repair_tie_fanout [join $low /]
repair_tie_fanout [join $high /]
legalize
shorten
write_db place.odb
