# Detailed routes along the global ones of `loads`, with diodes where a gate's net is too large an antenna; fillers last,
# since a diode wants a free site.
source common.tcl
open_stage loads
set_propagated_clock [all_clocks]
routing_layers

# New cells are not on the supplies yet in every release, and their rails would be shorts to the router.
proc route_in_detail {} {
  global_connect
  detailed_route -output_drc route_drc.rpt -verbose 1
}

# Antennas wait for the real routes: on global routes the router's second pass after a diode ends the run in some
# releases ("heap underflow", GRT-0183), and what it estimates is not what is left.
route_in_detail
for {set turn 0} {$turn < 3 && [check_antennas] > 0} {incr turn} {
  if {[repair_antennas $diode] == 0} { break }
  route_in_detail
}
filler_placement $fill
global_connect
check_placement -verbose
measured router_drc_violations [detailed_route_num_drvs]
measured router_antennas [check_antennas]
write_db route.odb
