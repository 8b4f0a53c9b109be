# Routes, with diodes where a gate's wire is too long an antenna; fillers last, since a diode wants a free site.
source common.tcl
open_stage loads
set_propagated_clock [all_clocks]
routing_layers

# New cells are not on the supplies yet in every release, and their rails would be shorts to the router.
proc route_in_detail {} {
  global_connect
  detailed_route -output_drc route_drc.rpt -verbose 1
}

global_route -guide_file route.guide -congestion_iterations 100

# A design that repair left late stops here, before the hours of detailed routing. In this process, since a second
# global_route in one gives estimates without their pins (26Q2).
estimate_parasitics -global_routing -spef_file global.spef
foreach {name path} {setup max hold min} {
  set slack [worst_slack -$path]
  measured estimated_${name}_ns $slack
  if {$slack < 0} {
    error "$name slack is $slack ns after repair, with estimated wires: must be at least 0"
  }
}

# Antennas wait for the real wires: on global routes the router's second pass after a diode ends the run in some releases
# ("heap underflow", GRT-0183), and what it estimates is not what is left.
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
