"""Bits of a design that never change after its reset, proven: they need no toggle.

Yosys writes every signal of every instance as an output of a netlist that begins with a reset; ABC merges what is equal
in every state that any inputs can reach (`lcorr` and `scorr`, inductions; `fraig`). A bit is constant where it became
0, 1, or the register that says whether the reset is over.
"""

import re
import tempfile
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

from talbot.rtl.harness.ports import Port, split
from talbot.rtl.replay import load
from talbot.signoff.netlist.verilog import modules
from talbot.verif.verilated.program import tool

STARTED = "started"
LARGE = 5000  # bits, from which on the last induction is of constants alone
SCRIPT = """read_verilog -sv dut.v top.v
hierarchy -check -top Top; proc; flatten -noscopeinfo; setundef -init -zero; opt_expr; memory_map; techmap; async2sync
dfflegalize -cell $_DFF_P_ 0; setundef -undriven -zero; expose w:dut.* w:started; write_blif all.blif
"""


def constants(path: str) -> list[tuple[str, str, int]]:
    """Return the constant bits of the component of the trace ``path``, ascending."""
    trace = load(path, cycles=False)
    return sorted(constant_bits(trace.verilog(), trace.cls, trace.ports))


def constant_bits(verilog: str, top: str, ports: Sequence[Port]) -> set[tuple[str, str, int]]:
    """Return (module, signal, bit) of the bits that are constant in every instance of their module.

    signal: as Verilator names it, with the field of a struct. Raises ToolError.
    """
    inputs, _ = split(ports)
    pins = [f".clk(clk), .reset(reset_in | ~{STARTED})", *(f".{p.name}({p.name})" for p in inputs if p.name != "reset")]
    heads = ["input clk", "input reset_in", *(f"input [{p.width - 1}:0] {p.name}" for p in inputs if p.name != "reset")]
    text = (
        f"module Top({', '.join(heads)});\n  reg {STARTED} = 0;\n  always @(posedge clk) {STARTED} <= 1;\n"
        f"  {top} dut({', '.join(pins)});\nendmodule\n"
    )
    with tempfile.TemporaryDirectory(prefix="talbot-") as temporary:
        folder = Path(temporary)
        (folder / "dut.v").write_text(verilog, encoding="utf-8")
        (folder / "top.v").write_text(text, encoding="utf-8")
        (folder / "script.ys").write_text(SCRIPT.replace("; ", "\n"), encoding="utf-8")
        tool(["yosys", "-q", "script.ys"], cwd=folder)
        (line,) = re.findall(
            r"(?m)^\.outputs (.*)", (folder / "all.blif").read_text(encoding="utf-8").replace("\\\n", "")
        )
        places = [re.fullmatch(r"(.*?)(?:\[(\d+)\])?", name) for name in line.split()]
        last = "scorr" if len(places) < LARGE else "scorr -k"
        tool(
            ["yosys-abc", "-c", f"read_blif all.blif; strash; zero; lcorr; fraig; {last}; write_aiger small.aig"],
            cwd=folder,
        )
        literals = outputs((folder / "small.aig").read_bytes())
    named = [(m[1], int(m[2] or 0), literal) for m, literal in zip(places, literals, strict=True) if m]
    fixed = {0, 1} | {literal ^ odd for name, _, literal in named if name == STARTED for odd in (0, 1)}
    instances, fields = modules_of(verilog, top), fields_of(verilog)
    changing, seen = set(), set()
    for name, bit, literal in named:
        path, _, signal = name.rpartition(".")
        if module := instances.get(path):
            place = (module, *fields.get((module, signal), {}).get(bit, (signal, bit)))
            seen.add(place)
            changing |= {place} if literal not in fixed else set()
    return seen - changing


def outputs(aiger: bytes) -> list[int]:
    """Return the literals of the outputs of a binary AIGER file."""
    head, body = aiger.split(b"\n", 1)
    _, _, _, latches, count, *_ = head.split()
    lines = body.split(b"\n", int(latches) + int(count))
    return [int(line) for line in lines[int(latches) : int(latches) + int(count)]]


def modules_of(verilog: str, top: str) -> dict[str, str]:
    """Return the module of each instance by its path, 'dut' for the top."""
    inside = {name: re.findall(r"(?m)^  (\w+) (\w+)\n  \(", body) for name, body in modules(verilog).items()}
    instances, todo = {}, [("dut", top)]
    while todo:
        path, module = todo.pop()
        instances[path] = module
        todo += [(f"{path}.{name}", of) for of, name in inside[module]]
    return instances


def fields_of(verilog: str) -> dict[tuple[str, str], dict[int, tuple[str, int]]]:
    """Return, for each (module, signal) of a struct's type, its bits as (signal.field, bit)."""
    structs: dict[str, list[tuple[str, int]]] = {}
    for body, name in re.findall(r"(?s)typedef struct packed \{\n(.*?)\} (\w+);", verilog):
        structs[name] = [
            (field, int(high or 0)) for high, field in re.findall(r"logic (?:\[(\d+):0\] )?(\w+);", body)
        ]  # the first in the highest bits
    fields: dict[tuple[str, str], dict[int, tuple[str, int]]] = defaultdict(dict)
    for module, body in modules(verilog).items():
        for kind, signal in re.findall(r"(?m)^  (?:input +|output )?(\w+) (\w+) *[;,]?$", body):
            low = 0
            for field, high in reversed(structs.get(kind, [])):
                fields[module, signal] |= {low + bit: (f"{signal}.{field}", bit) for bit in range(high + 1)}
                low += high + 1
    return fields
