"""A recorded trace replayed through a netlist in Icarus at the clock's full rate, with delays; transitions are counted.

A trace (rtl/replay's) has lines 'fresh inputs outputs', hexadecimal, packed port by port, the first lowest; fresh marks
a simulator's first cycle, where registers hold anything.
"""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.steps import StepError
from talbot.base.tools import ToolError, finish, run
from talbot.flow.layout.timing.delays import Delays, constrained, icarus, specified
from talbot.signoff.netlist.names import plain_names
from talbot.signoff.netlist.netlist import Instance, Netlist

BENCH = """`timescale 1ns/1ps
module Replay;
  reg clk = 0, fresh, counting = 0;
  reg [{in_top}:0] in, next;
  reg [{out_top}:0] want;
  wire [{out_top}:0] got;
  wire [{out_top}:0] care = {{{care}}};
  real setup_margin = 1e9, hold_margin = 1e9, begun = 0;
  {top} dut ({pins});
  integer file, cycle = 0, wrong = 0;
  reg [8*1024-1:0] name;
  initial begin
    {annotate}
    if (!$value$plusargs("trace=%s", name)) $fatal(1, "+trace=FILE is missing");
    file = $fopen(name, "r");
    if (file == 0) $fatal(1, "+trace: cannot be read");
    while ($fscanf(file, "%b %h %h", fresh, next, want) == 3) begin
      #{input_ns} in = next;
      #{fall_ns} clk = 0;
      #{sample_ns};
      if (!fresh && (((got ^ want) & care) !== {out_bits}'b0 || ^got === 1'bx)) begin
        wrong = wrong + 1;
        if (wrong <= 5) $display("WRONG %0d %b %b", cycle, want, got);
      end
      #{edge_ns} clk = 1;
      if (cycle == {settled}) begin counting = 1; begun = $realtime; end
      cycle = cycle + 1;
    end
    counting = 0;
    #1;
    $display("END %0d %0d", cycle, wrong);
    $display("MARGIN %.4f %.4f", setup_margin, hold_margin);
    $finish;
  end
endmodule
module Check (input clk, input d);
  parameter real SETUP = 0, HOLD = 0;
  realtime changed = -1e6, edge_at = -1e6;
  real margin;
  always @(d) begin
    changed = $realtime;
    margin = changed - edge_at - HOLD;
    if (Replay.counting && margin < Replay.hold_margin) Replay.hold_margin = margin;
    if (Replay.counting && margin < 0) $display("HOLD %m %.4f", margin);
  end
  always @(posedge clk) begin
    edge_at = $realtime;
    margin = edge_at - changed - SETUP;
    if (Replay.counting && margin < Replay.setup_margin) Replay.setup_margin = margin;
    if (Replay.counting && margin < 0) $display("SETUP %m %.4f", margin);
  end
endmodule
module Count (input a);
  integer changes = 0;
  real high = 0, since = 0;
  always @(a) if (Replay.counting) begin
    changes = changes + 1;
    if (a === 1'b1) since = $realtime;
    else if (since > 0) begin high = high + $realtime - since; since = 0; end
  end
  always @(posedge Replay.counting) if (a === 1'b1) since = $realtime;
  always @(negedge Replay.counting) begin
    if (a === 1'b1 && since > 0) high = high + $realtime - since;
    $display("NET %m %0d %.6f", changes, high / ($realtime - Replay.begun));
  end
endmodule
"""
SETTLED = 8  # cycles after which a reset has been taken, and transitions count
CLOCK_PIN = "clk"  # of the library's registers
CARE = "1'b1"


@dataclass(frozen=True)
class Timing:
    """Period of the clock; I/O delays outside as shares of it."""

    period_ns: float
    input_delay: float
    output_delay: float


@dataclass(frozen=True)
class Replayed:
    """Result of a replay.

    cycles: simulated; wrong: those with an output that differs or is X; first: lines about the first of these. margins:
    the least of setup and hold, ns, None without delays. late: lines about failed checks. activity: net -> (transitions
    a cycle, share of time at 1), where counted.
    """

    cycles: int
    wrong: int
    first: tuple[str, ...]
    margins: tuple[float, float] | None
    late: tuple[str, ...]
    activity: dict[str, tuple[float, float]]


def replay(
    netlist: Netlist,
    cells: str,
    trace: Path,
    timing: Timing,
    folder: Path,
    delays: Delays | None = None,
    count: bool = False,
) -> Replayed:
    """Replay the trace whose head is the file ``trace`` (.json; its lines beside it, .trace) through ``netlist``.

    cells: Verilog of the cells. folder: of the files that Icarus reads. count: whether to count transitions. Raises
    ToolError, StepError.
    """
    nets = plain_names(netlist)
    names = {instance.name: f"x{k}" for k, instance in enumerate(netlist.instances)}
    head = json.loads(trace.read_text(encoding="utf-8"))
    (folder / "cells.log").write_text(specified(cells, delays, netlist) if delays else cells, encoding="utf-8")
    (folder / "netlist.log").write_text(_netlist(netlist, nets, names, delays, count), encoding="utf-8")
    (folder / "bench.log").write_text(
        _bench(netlist.name, head["ports"], timing, folder if delays else None), encoding="utf-8"
    )
    if delays:
        (folder / "delays.log").write_text(icarus(delays, netlist, names), encoding="utf-8")
    program = folder / "replay.log"
    sources = [folder / f"{name}.log" for name in ("bench", "netlist", "cells")]
    run(["iverilog", "-g2012", "-gspecify", "-s", "Replay", "-o", program, *sources])
    done = finish(["vvp", "-n", program, f"+trace={trace.with_suffix('.trace')}"])
    program.unlink()
    output = done.stdout + done.stderr
    if lost := next((line for line in output.splitlines() if "SDF ERROR" in line or "SDF WARNING" in line), None):
        raise StepError(f"replay: Icarus did not annotate all delays: {lost}")
    end = re.search(r"^END (\d+) (\d+)$", done.stdout, re.M)
    if done.returncode or not end or int(end[1]) != head["cycles"]:
        raise ToolError(f"vvp: the replay ended early: {output.strip()[-300:]}")
    margin = re.search(r"^MARGIN (\S+) (\S+)$", done.stdout, re.M)
    back = {plain: net for net, plain in nets.items()}
    found = re.findall(r"^NET Replay\.dut\.n(w\d+) (\d+) (\S+)$", done.stdout, re.M)
    cycles = int(end[1]) - SETTLED
    return Replayed(
        int(end[1]),
        int(end[2]),
        tuple(re.findall(r"^WRONG .*$", done.stdout, re.M)),
        (float(margin[1]), float(margin[2])) if delays and margin else None,
        tuple(re.findall(r"^(?:SETUP|HOLD) .*$", done.stdout, re.M)),
        {back[plain]: (int(changes) / cycles, float(high)) for plain, changes, high in found},
    )


def _netlist(
    netlist: Netlist, nets: Mapping[str, str], names: Mapping[str, str], delays: Delays | None, count: bool
) -> str:
    """Verilog of the netlist with short names, the checks of its registers and counters of its nets."""
    ports = {net for port in netlist.ports for net in port.bits()}
    short = {net: net if net in ports else plain for net, plain in nets.items()}
    renamed, lines = [], []
    for i in netlist.instances:
        pins: dict[str, str] = {}
        for pin, net in i.pins.items():
            again = short[net] in pins.values()
            if again:  # Icarus 11 annotates one path where two inputs are the same net
                lines.append(f"  buf (s{len(lines)}, {short[net]});")
            pins[pin] = f"s{len(lines) - 1}" if again else short[net]
        renamed.append(Instance(names[i.name], i.cell, pins))
    for k, check in enumerate(constrained(delays, netlist) if delays else ()):
        clock, data = (short[check.instance.net(pin)] for pin in (CLOCK_PIN, check.pin))
        times = f".SETUP({check.setup:.4f}), .HOLD({check.hold:.4f})"
        lines.append(f"  Check #({times}) k{k} (.clk({clock}), .d({data}));")
    if count:
        lines += [f"  Count n{plain} (.a({short[net]}));" for net, plain in nets.items()]
    text = Netlist(netlist.name, netlist.ports, tuple(renamed)).verilog()
    return text.replace("endmodule", "\n".join([*lines, "endmodule"]))


def _bench(top: str, ports: Sequence[dict[str, Any]], timing: Timing, folder: Path | None) -> str:
    """Verilog of the bench. ports: of the trace's head, in the order in which they are packed."""
    pins, widths, cares, valid = [".clk(clk)"], {"in": 0, "got": 0}, [], {}
    for port in ports:
        name, vector = port["path"].replace(".", "__"), "got" if port["output"] else "in"
        pins.append(f".{name}({vector}[{widths[vector]} +: {port['width']}])")
        if port["output"]:
            valid[name] = f"want[{widths[vector]}]"
            cares.append((name, port["width"]))
        widths[vector] += port["width"]
    valid = {name.removesuffix("val") + "msg": bit for name, bit in valid.items() if name.endswith("__val")}
    care = ", ".join(f"{{{width}{{{valid.get(name, CARE)}}}}}" for name, width in reversed(cares))
    half, arrive = timing.period_ns / 2, timing.period_ns * timing.input_delay
    sample = timing.period_ns * (1 - timing.output_delay)
    waits = {"input": arrive, "fall": half - arrive, "sample": sample - half, "edge": timing.period_ns - sample}
    words = {f"{name}_ns": f"{ns:.4f}" for name, ns in waits.items()} | {"top": top, "pins": ", ".join(pins)}
    words |= {"in_top": widths["in"] - 1, "out_top": widths["got"] - 1, "out_bits": widths["got"], "care": care}
    annotate = f'$sdf_annotate("{folder / "delays.log"}", dut);' if folder else ""
    return BENCH.format(annotate=annotate, settled=SETTLED, **words)
