"""Whether any input tells a mutant from the original: a miter of both, by induction and IC3 (`pdr`) of Yosys's ABC."""

import re
import tempfile
from pathlib import Path

from rtl.ports import Port, split, validity
from verif.coverage.program import ToolTimeout, tool

from .mutants import BITS, yosys

# Engines in turn, each with its limit in seconds: a proof that is easy, a search for a difference, a proof that is not
ENGINES = (("scorr; dc2; scorr; pdr -T 4", 15), ("bmc3 -F 200 -T 10", 20), ("scorr; dc2; scorr; pdr -T 40", 60))

# What a block's neighbours promise (docs/chip.md): inputs that stand while an output of it is high; RegFile's proof of
# p_write shows it. And outputs that mean something only while another one is high.
STANDS = {"ReadoutSeq": ("busy", ("mode", "mask", "row0", "row1", "col0", "col1", "decimation", "overlap"))}
MEANS = {"ReadoutSeq": {"amp_row": "busy"}}

EQUIVALENT, DIFFERENT, UNKNOWN = "equivalent", "different", "unknown"

# The machine code of the miter: two-input gates and flip-flops that start at 0
SCRIPT = """read_verilog -sv mutants.v miter.v; hierarchy -check -top Miter; flatten; proc; setundef -init -zero;
opt -full; memory_map; opt; techmap; opt; async2sync; dfflegalize -cell $_DFF_P_ 0; opt_clean; setundef -undriven -zero; abc -g AND; opt_clean;
aigmap; opt_clean; stat; write_aiger -zinit -symbols miter.aig"""


def miter(top, ports, number):
    """Verilog of module Miter: `bad` where an output of mutant ``number`` of ``top`` differs, behind the first reset.

    A message counts while it is valid, and all of it while the neighbours keep their promises.
    """
    inputs, outputs = split(ports)
    valid = validity(ports)
    lines = ["module Miter(input clk, input reset_in" + "".join(
        f", input [{p.width - 1}:0] {p.name}" for p in inputs if p.name != "reset") + ", output bad);",
        "  reg started = 0;", "  wire reset = reset_in | ~started;"]
    for port in outputs:
        lines.append(f"  wire [{port.width - 1}:0] {port.name}, other_{port.name};")
    for name, which, prefix in (("gold", 0, ""), ("gate", number, "other_")):
        pins = [".clk(clk)", f".mutant({BITS}'d{which})", *(f".{p.name}({p.name})" for p in inputs),
                *(f".{p.name}({prefix}{p.name})" for p in outputs)]
        lines.append(f"  {top} {name}({', '.join(pins)});")
    valid = {p.name: v.name for p, v in valid.items()} | MEANS.get(top, {})
    differ = [f"({valid.get(p.name, 1)} & ({p.name} != other_{p.name}))" for p in outputs]
    return "\n".join([
        *lines, *promises(top), "  always @(posedge clk) started <= 1;",
        f"  assign bad = started & promised & ({' | '.join(differ)});", "endmodule", ""])


def promises(top):
    """Verilog of `promised`: all that the neighbours of ``top`` promise has been kept so far."""
    if top not in STANDS:
        return ["  wire promised = 1;"]
    while_high, names = STANDS[top]
    now = "{" + ", ".join(names) + "}"
    return ["  reg kept = 1;", f"  reg [$bits({now}) - 1:0] before;",
            f"  wire promised = kept & (~{while_high} | reset | {now} == before);",
            f"  always @(posedge clk) begin kept <= promised; before <= {now}; end"]


def module_ports(verilog, module):
    """Ports of a module that Yosys wrote, but clk and mutant: tuple of Port."""
    text = re.search(rf"(?s)^module {module}\(.*?^endmodule", verilog, re.MULTILINE)[0]
    found = re.findall(r"^  (input|output) (?:\[(\d+):0\] )?(\w+) *;", text, re.MULTILINE)
    return tuple(Port(name.replace("__", "."), int(high or 0) + 1, way == "output")
                 for way, high, name in found if name not in ("clk", "mutant"))


def the_same(verilog, module, number):
    """True if mutant ``number`` changes nothing at the ports of its own ``module``, which is small."""
    return compare(verilog, module, module_ports(verilog, module), number, ENGINES[:1])[0] == EQUIVALENT


def compare(verilog, top, ports, number, engines=ENGINES):
    """EQUIVALENT, DIFFERENT or UNKNOWN, and the cycles to the difference found (0 for none). verilog: with mutants."""
    files = yosys(SCRIPT.replace("\n", " "), {"mutants.v": verilog, "miter.v": miter(top, ports, number)})
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        (Path(folder) / "miter.aig").write_bytes(files["miter.aig"])
        for engine, seconds in engines:
            try:
                said = tool(["yosys-abc", "-c", f"read_aiger miter.aig; strash; {engine}"], seconds, cwd=folder)
            except ToolTimeout:
                continue
            if "roperty proved" in said or "Networks are equivalent" in said:
                return EQUIVALENT, 0
            if found := re.search(r"was asserted in frame (\d+)", said):
                return DIFFERENT, int(found[1])
    return UNKNOWN, 0
