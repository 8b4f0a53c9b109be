# Netlist -> rows and tracks. In a frame (die, core: boxes in um) the outline is given.
source common.tcl
read_netlist
if {[llength $die]} {
  initialize_floorplan -site $site -die_area $die -core_area $core
} else {
  initialize_floorplan -site $site -utilization $utilization -aspect_ratio $aspect -core_space $core_space
}
make_tracks
if {$new_buffers} { remove_buffers }
if {$tap ne ""} {
  tapcell -distance $tap_distance -tapcell_master $tap -endcap_master $endcap
}
write_db floorplan.odb
