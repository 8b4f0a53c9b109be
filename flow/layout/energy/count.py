"""Transitions of every net of a netlist through a frame in Icarus, at zero delay, part by part of the run.

Of a net's changes within one instant (order of evaluation, not glitches) only the difference that remains counts.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from talbot.base.steps import StepError
from talbot.signoff.netlist.names import plain_names
from talbot.signoff.netlist.netlist import Instance, Netlist

PARTS = "host", "frame", "after"  # before the chip is busy, while it is, and then
COUNTERS = """
module Meter;
  reg [2:0] part = 0;
  integer file, cycles = 0;
  reg [8*512-1:0] name;
  initial begin
    if (!$value$plusargs("counts=%s", name)) $fatal(1, "+counts=FILE is missing");
    file = $fopen(name, "w");
  end
  always @(negedge Clock.clk) begin
    if (part == 0 ? Clock.reset === 1'b0 : part == 1 ? Clock.bench.busy : part == 2 ? !Clock.bench.busy
        : part == 3 && Clock.done) begin
      if (part > 0) $fwrite(file, "cycles %0d %0d\\n", part, cycles);
      part = part + 1;
      cycles = 0;
    end
    cycles = cycles + 1;
  end
endmodule
module Count (input a);
  integer changes = 0;
  reg last, settled;
  time at = 0;
  always @(a) begin
    if ($time != at) begin
      if (last !== settled) changes = changes + 1;
      settled = last;
      at = $time;
    end
    last = a;
  end
  always @(Meter.part) begin
    if (last !== settled) changes = changes + 1;
    settled = last;
    if (Meter.part > 1) $fwrite(Meter.file, "%m %0d %0d\\n", Meter.part - 1, changes);
    changes = 0;
  end
endmodule
"""


@dataclass(frozen=True)
class Part:
    """Part of a run. cycles: its length. transitions: net -> how many."""

    cycles: int
    transitions: Mapping[str, int]


def nets_of(netlist: Netlist) -> dict[str, str]:
    """Short name of each net, as the counters have it."""
    return plain_names(netlist)


def counted_verilog(netlist: Netlist) -> str:
    """Verilog of the netlist with short names and a counter at every net, and of what they report to."""
    nets = nets_of(netlist)
    ports = {net for port in netlist.ports for net in port.bits()}
    short = {net: net if net in ports else plain for net, plain in nets.items()}
    instances = tuple(
        Instance(f"x{k}", i.cell, {pin: short[net] for pin, net in i.pins.items()})
        for k, i in enumerate(netlist.instances)
    )
    text = Netlist(netlist.name, netlist.ports, instances).verilog()
    counters = "".join(f"  Count n{plain} (.a({short[net]}));\n" for net, plain in nets.items())
    return text.replace("endmodule", counters + "endmodule") + COUNTERS


def read_counts(file: Path, netlist: Netlist) -> dict[str, Part]:
    """The PARTS of a run whose counters wrote ``file``. Raises StepError where one is not whole."""
    text = file.read_text(encoding="utf-8")
    cycles = {int(part): int(count) for part, count in re.findall(r"(?m)^cycles (\d+) (\d+)$", text)}
    nets = {plain: net for net, plain in nets_of(netlist).items()}
    found: dict[int, dict[str, int]] = {}
    for plain, part, changes in re.findall(r"(?m)^\S+\.n(w\d+) (\d+) (\d+)$", text):
        found.setdefault(int(part), {})[nets[plain]] = int(changes)
    made = {}
    for number, name in enumerate(PARTS, 1):
        if number not in cycles or len(found.get(number, ())) != len(nets):
            raise StepError(f"{file.name}: the counters of the part {name!r} did not all report")
        made[name] = Part(cycles[number], found[number])
    return made
