# Diodes where a gate's net is too large an antenna; fillers last, since a diode wants a free site.
source common.tcl
open_stage route
set_propagated_clock [all_clocks]
routing_layers

# Antennas wait for the real routes: on global routes the router's second pass after a diode ends the run in some
# releases ("heap underflow", GRT-0183), and what it estimates is not what is left.
for {set turn 0} {$turn < 3 && [check_antennas] > 0} {incr turn} {
  if {[repair_antennas $diode] == 0} { break }
  route_in_detail
}
filler_placement $fill
global_connect
check_placement -verbose
measured router_drc_violations [violations]
measured router_antennas [check_antennas]
write_db mend.odb
write_def mend.def
