# Routes, with diodes where a gate's wire is too long an antenna.
source common.tcl
open_stage hold typical
set_routing_layers -signal $signal_layers -clock $clock_layers
pin_access
global_route -guide_file route.guide -congestion_iterations 100
repair_antennas -iterations 5
filler_placement $fill
global_connect
check_placement -verbose
detailed_route -output_drc route_drc.rpt -verbose 1
measured drc_violations [detailed_route_num_drvs]
measured antenna_violations [check_antennas]
write_db route.odb
