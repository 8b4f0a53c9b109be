# Netlist -> rows and tracks.
source common.tcl
read_lef $tech_lef
read_lef $cell_lef
read_cells
read_verilog netlist.v
link_design $top
read_sdc $constraints
initialize_floorplan -site $site -utilization $utilization -aspect_ratio $aspect -core_space $core_space
make_tracks
remove_buffers
tapcell -distance $tap_distance -tapcell_master $tap -endcap_master $endcap
write_db floorplan.odb
