"""Commands of OpenROAD that the stages may use: their keys, flags and arguments, as its documentation has them.

README: src/<module>/README.md of The-OpenROAD-Project/OpenROAD. Tcl: a command's sta::define_cmd_args there. STA: the
OpenSTA manual. Flow: test/flow.tcl and test/sky130hd/sky130hd.pdn.tcl there, which its own regressions run. LL: the
scripts of LibreLane 3.0.17, SC: of SiliconCompiler 0.38.11, which run on OpenROAD daily. Every name, key and flag is
also in the Tcl of release 26Q2 (April 2026), but for set_extraction_rules_file, which came later.
"""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Command:
    """keys: take a value; flags: take none; least, most: further arguments; writes: the key or 'argument' that names a
    file which it writes; says: what it returns."""

    source: str
    keys: tuple = ()
    flags: tuple = ()
    least: int = 0
    most: int = 0
    writes: str = ""
    says: str = ""


def _words(text):
    return tuple(text.split())


COMMANDS = {
    "read_lef": Command("odb, main README", (), _words("-tech -library"), 1, 1),
    "read_liberty": Command("STA", _words("-corner"), _words("-min -max -infer_latches"), 1, 1),
    "read_verilog": Command("main README", (), (), 1, 1),
    "define_corners": Command("STA; test/gcd_sky130hd_fast_slow.tcl", (), (), 1, 9),
    "link_design": Command("main README", (), _words("-hier"), 0, 1),
    "read_sdc": Command("STA", (), _words("-echo"), 1, 1),
    "read_db": Command("main README", (), _words("-hier"), 1, 1),
    "write_db": Command("main README", (), (), 1, 1, "argument"),
    "write_def": Command("main README", _words("-version"), (), 1, 1, "argument"),
    "write_verilog": Command("Tcl, dbSta", _words("-remove_cells"), _words("-sort -include_pwr_gnd"), 1, 1, "argument"),
    "write_abstract_lef": Command(
        "Tcl, OpenRoad", _words("-bloat_factor"), _words("-bloat_occupied_layers"), 1, 1, "argument"
    ),
    "initialize_floorplan": Command(
        "ifp README",
        _words(
            "-site -die_area -core_area -utilization -aspect_ratio -core_space -additional_sites -row_parity"
            " -flip_sites"
        ),
    ),
    "make_tracks": Command("ifp README", _words("-x_pitch -y_pitch -x_offset -y_offset"), (), 0, 1),
    "tapcell": Command(
        "tap README",
        _words("-tapcell_master -endcap_master -distance -halo_width_x -halo_width_y -tap_prefix -endcap_prefix"),
    ),
    "remove_buffers": Command("rsz README; SC", (), (), 0, 1),
    "add_global_connection": Command(
        "Tcl, OpenRoad; Flow",
        _words("-net -inst_pattern -pin_pattern -region"),
        _words("-power -ground -defer_connection"),
    ),
    "global_connect": Command("Tcl, OpenRoad; Flow"),
    "set_voltage_domain": Command(
        "pdn README", _words("-name -power -ground -region -secondary_power -switched_power")
    ),
    "define_pdn_grid": Command(
        "pdn README",
        _words("-name -voltage_domains -pins -starts_with -obstructions -orient -instances -cells -halo"),
        _words("-macro -grid_over_pg_pins -grid_over_boundary -default -existing"),
    ),
    "add_pdn_stripe": Command(
        "pdn README",
        _words("-layer -grid -width -pitch -spacing -offset -starts_with -number_of_straps -nets"),
        _words("-followpins -extend_to_core_ring -extend_to_boundary -snap_to_grid"),
    ),
    "add_pdn_connect": Command(
        "pdn README",
        _words("-layers -grid -cut_pitch -fixed_vias -dont_use_vias -max_rows -max_columns -ongrid -split_cuts"),
    ),
    "pdngen": Command(
        "pdn README", _words("-failed_via_report"), _words("-skip_trim -dont_add_pins -reset -ripup -report_only")
    ),
    "set_routing_layers": Command("grt README", _words("-signal -clock")),
    "set_global_routing_layer_adjustment": Command("grt README; Flow, LL, SC", (), (), 2, 2),
    "global_placement": Command(
        "gpl README",
        _words("-density -pad_left -pad_right -overflow -bin_grid_count"),
        _words("-skip_io -routability_driven -timing_driven -incremental -skip_initial_place"),
    ),
    "place_pins": Command(
        "ppl README",
        _words("-hor_layers -ver_layers -random_seed -corner_avoidance -min_distance"),
        _words("-random -min_distance_in_tracks -annealing"),
    ),
    "set_wire_rc": Command(
        "est and rsz README", _words("-layer -layers -resistance -capacitance -corner"), _words("-clock -signal -data")
    ),
    "set_layer_rc": Command(
        "est README; test/sky130hd/sky130hd.rc", _words("-layer -via -capacitance -resistance -corner")
    ),
    "set_dont_use": Command("rsz README", (), (), 1, 1),
    "estimate_parasitics": Command(
        "est and rsz README", _words("-spef_file"), _words("-placement -global_routing"), writes="-spef_file"
    ),
    "buffer_ports": Command("rsz README", _words("-buffer_cell -max_utilization"), _words("-inputs -outputs -verbose")),
    "repair_design": Command(
        "rsz README",
        _words("-max_wire_length -slew_margin -cap_margin -max_utilization"),
        _words("-pre_placement -match_cell_footprint -verbose"),
    ),
    "repair_tie_fanout": Command("rsz README", _words("-separation -max_fanout"), _words("-verbose"), 1, 1),
    "repair_timing": Command(
        "rsz README",
        _words(
            "-setup_margin -hold_margin -slack_margin -repair_tns -max_utilization -max_buffer_percent -recover_power"
        ),
        _words("-setup -hold -allow_setup_violations -skip_pin_swap -skip_gate_cloning -skip_buffering -verbose"),
    ),
    "repair_clock_inverters": Command("rsz README"),
    "repair_clock_nets": Command("rsz README; LL, SC", _words("-max_wire_length")),
    "set_placement_padding": Command("dpl README", _words("-masters -instances -left -right"), _words("-global"), 0, 1),
    "gpl::get_global_placement_uniform_density": Command("Tcl, replace", _words("-pad_left -pad_right"), says="0.6"),
    "detailed_placement": Command(
        "dpl README", _words("-max_displacement -report_file_name"), _words("-disallow_one_site_gaps")
    ),
    "check_placement": Command(
        "dpl README", _words("-report_file_name"), _words("-verbose -disallow_one_site_gaps"), says="0"
    ),
    "improve_placement": Command("dpl README", _words("-random_seed -max_displacement")),
    "optimize_mirroring": Command("dpl README; LL, SC"),
    "filler_placement": Command("dpl README; LL, SC", _words("-prefix"), _words("-verbose"), 1, 1),
    "clock_tree_synthesis": Command(
        "cts README",
        _words("-buf_list -root_buf -wire_unit -clk_nets -sink_clustering_size -sink_clustering_max_diameter"),
        _words("-sink_clustering_enable -balance_levels -obstruction_aware"),
    ),
    "global_route": Command(
        "grt README",
        _words("-guide_file -congestion_iterations -congestion_report_file -grid_origin -critical_nets_percentage"),
        _words("-allow_congestion -verbose"),
        writes="-guide_file",
    ),
    "repair_antennas": Command(
        "grt README; LL, SC",
        _words("-iterations -ratio_margin"),
        _words("-jumper_only -diode_only -allow_congestion"),
        0,
        1,
        says="0",
    ),
    "detailed_route": Command(
        "drt README",
        _words("-output_maze -output_drc -droute_end_iter -or_seed -or_k -verbose -min_access_points"),
        _words("-disable_via_gen -clean_patches -no_pin_access -save_guide_updates"),
        writes="-output_drc",
    ),
    "detailed_route_num_drvs": Command("Tcl, TritonRoute; Flow", says="0"),
    "check_antennas": Command(
        "Tcl, ant; Flow", _words("-report_file -net"), _words("-report_violating_nets -verbose"), says="0"
    ),
    "define_process_corner": Command("Tcl, rcx; Flow", _words("-ext_model_index"), (), 1, 1),
    "set_extraction_rules_file": Command("flow-scripts, final_report.tcl; SC", (), (), 1, 1),
    "extract_parasitics": Command(
        "rcx README",
        _words("-corner_cnt -max_res -coupling_threshold -cc_model -context_depth"),
        _words("-lef_res -no_merge_via_res"),
    ),
    "write_spef": Command("rcx README", _words("-net_id"), (), 1, 1, "argument"),
    "read_spef": Command("STA", _words("-path -corner -name"), _words("-min -max -keep_capacitive_coupling"), 1, 1),
    "report_design_area": Command("rsz README"),
    "report_floating_nets": Command("rsz README", (), _words("-verbose")),
    "report_checks": Command(
        "STA",
        _words("-path_delay -fields -digits -format -corner -slack_max -group_count"),
        _words("-unconstrained -no_line_splits"),
    ),
    "report_check_types": Command(
        "STA", _words("-digits -corner"), _words("-violators -max_slew -max_capacitance -max_fanout -verbose")
    ),
    "report_power": Command("STA", _words("-digits -corner -instances")),
    "worst_slack": Command("STA", _words("-corner"), _words("-max -min"), says="1.5"),
    "sta::max_slew_violation_count": Command("STA, Search.i", says="0"),
    "sta::max_capacitance_violation_count": Command("STA, Search.i", says="0"),
    "ord::get_db_block": Command("Tcl, OpenRoad.i", says="block"),
    "write_sdf": Command(
        "STA", _words("-corner -divider -digits"), _words("-gzip -no_timestamp -no_version"), 1, 1, "argument"
    ),
    "set_propagated_clock": Command("STA", (), (), 1, 1),
    "all_clocks": Command("STA", says="clk"),
}

# What older releases have in place of these; None: not there
OLDER = COMMANDS | {
    "set_extraction_rules_file": None,
    "improve_placement": None,
    "extract_parasitics": replace(
        COMMANDS["extract_parasitics"], keys=(*COMMANDS["extract_parasitics"].keys, "-ext_model_file")
    ),
}
