"""Equivalence of a mutant and the original: a miter of both, by induction and IC3 (`pdr`) of Yosys's ABC."""

import re
import tempfile
from collections.abc import Sequence
from pathlib import Path

from talbot.base.paths import PACKAGE
from talbot.base.tools import ToolTimeout
from talbot.rtl.harness.ports import Port, split, validity
from talbot.verif.mutation.mutants import BITS, yosys
from talbot.verif.verilated.program import tool

# What scorr has reduced to a constant without registers, pdr leaves undecided: iprove, of a few conflicts, says so
REDUCE = "scorr; dc2; scorr; iprove -N 1 -C 10"
# Engines in turn, each with its limit in seconds: a short proof, a search for a difference, a long proof
ENGINES = ((f"{REDUCE}; pdr -T 4", 15), ("bmc3 -F 200 -T 10", 20), (f"{REDUCE}; pdr -T 40", 60))
PROVEN = "roperty proved", "Networks are equivalent", "UNSATISFIABLE"

EQUIVALENT, DIFFERENT, UNKNOWN = "equivalent", "different", "unknown"

# The miter as an AIG: two-input gates and flip-flops that start at 0
SCRIPT = """read_verilog -sv mutants.v miter.v; hierarchy -check -top Miter; flatten -noscopeinfo; proc;
opt_clean; memory_map; setundef -init -zero; opt -full; techmap; opt; async2sync; dfflegalize -cell $_DFF_P_ 0;
opt_clean; setundef -undriven -zero; abc -g AND; opt_clean; aigmap; opt_clean; stat;
write_aiger -zinit -symbols miter.aig"""


def miter(top: str, ports: Sequence[Port], number: int) -> str:
    """Return Verilog of module Miter: `bad` where an output of mutant ``number`` of ``top`` differs after a reset.

    A message counts while it is valid, and as long as the neighbours keep their promises.
    """
    inputs, outputs = split(ports)
    contract = promises(top)
    lines = [
        "module Miter(input clk, input reset_in"
        + "".join(f", input [{p.width - 1}:0] {p.name}" for p in inputs if p.name != "reset")
        + ", output bad);",
        "  reg started = 0;",
        "  wire reset = reset_in | ~started;",
    ]
    for port in outputs:
        lines.append(f"  wire [{port.width - 1}:0] {port.name}, other_{port.name};")
    for name, which, prefix in (("gold", 0, ""), ("gate", number, "other_")):
        pins = [
            ".clk(clk)",
            f".mutant({BITS}'d{which})",
            *(f".{p.name}({p.name})" for p in inputs),
            *(f".{p.name}({prefix}{p.name})" for p in outputs),
        ]
        lines.append(f"  {top} {name}({', '.join(pins)});")
    looked_at = {name: f"{name}_counts" for name in re.findall(r"output (\w+)_counts", contract)}
    counts = {p.name: v.name for p, v in validity(ports).items()} | looked_at
    lines += ["  wire promised;", *(f"  wire {wire};" for wire in looked_at.values())]
    lines.append(f"  {top}Promises promises(.*);" if contract else "  assign promised = 1;")
    differ = [f"({counts.get(p.name, 1)} & ({p.name} != other_{p.name}))" for p in outputs]
    return "\n".join(
        [
            *lines,
            "  always @(posedge clk) started <= 1;",
            f"  assign bad = started & promised & ({' | '.join(differ)});",
            "endmodule",
            contract,
        ]
    )


def promises(top: str) -> str:
    """Return module <top>Promises of rtl/<block>/formal/promises.sv, or ''.

    Its outputs: `promised`, the neighbours have kept their promises so far; <port>_counts, they read that output now.
    """
    modules = [
        text
        for text in map(Path.read_text, sorted(PACKAGE.glob("rtl/*/formal/promises.sv")))
        if re.search(rf"^module {top}Promises\b", text, re.MULTILINE)
    ]
    return modules[0] if modules else ""


def module_ports(verilog: str, module: str) -> tuple[Port, ...]:
    """Return the ports of a module that Yosys wrote, without clk and mutant."""
    (text,) = re.findall(rf"(?s)^module {module}\(.*?^endmodule", verilog, re.MULTILINE)
    ports = re.findall(r"^  (input|output) (?:\[(\d+):0\] )?(\w+) *;", text, re.MULTILINE)
    return tuple(
        Port(name.replace("__", "."), int(high or 0) + 1, way == "output")
        for way, high, name in ports
        if name not in ("clk", "mutant")
    )


def the_same(verilog: str, module: str, number: int) -> bool:
    """Return whether mutant ``number`` changes nothing at the ports of its ``module``, by the short proof."""
    return compare(verilog, module, module_ports(verilog, module), number, ENGINES[:1])[0] == EQUIVALENT


def compare(
    verilog: str, top: str, ports: Sequence[Port], number: int, engines: Sequence[tuple[str, int]] = ENGINES
) -> tuple[str, int]:
    """Return EQUIVALENT, DIFFERENT or UNKNOWN, and the cycles to the difference (0 for none). verilog: with mutants."""
    files = yosys(SCRIPT.replace("\n", " "), {"mutants.v": verilog, "miter.v": miter(top, ports, number)})
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        (Path(folder) / "miter.aig").write_bytes(files["miter.aig"])
        for engine, seconds in engines:
            try:
                output = tool(["yosys-abc", "-c", f"read_aiger miter.aig; strash; {engine}"], seconds, cwd=folder)
            except ToolTimeout:
                continue
            if any(text in output for text in PROVEN):
                return EQUIVALENT, 0
            if match := re.search(r"was asserted in frame (\d+)", output):
                return DIFFERENT, int(match[1])
    return UNKNOWN, 0
