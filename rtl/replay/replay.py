"""Recorded traces driven into Verilog in Icarus: every output equals the trace in every cycle, and is never X."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.tools import ToolTimeout, finish
from talbot.rtl.harness.icarus import TIMESCALE, IcarusError, compile_program, instance
from talbot.rtl.harness.ports import Port, places, split, total_width, validity
from talbot.rtl.replay.trace import Trace, load

SECONDS = 300.0  # a simulation that takes longer hangs


@dataclass(frozen=True)
class Mismatch:
    """A ``port`` of the Verilog that differs in a ``cycle`` of the trace, which ``test`` drove; values in binary."""

    test: str
    cycle: int
    port: str
    expected: str
    got: str

    def __str__(self) -> str:
        return f"{self.test}: cycle {self.cycle}: {self.port}: expected {self.expected}, got {self.got}"


def bench(top: str, ports: Sequence[Port], strict: bool = False) -> str:
    """Return module ReplayBench, which drives the cycles of +trace=FILE into module ``top``, to the first mismatch.

    The msg of an output stream counts when its val is 1, or always if ``strict``; X and Z never match.
    """
    inputs, outputs = split(ports)
    where, valid = places(outputs), {} if strict else validity(ports)
    care = [
        f"{{{port.width}{{want[{where[valid[port]]}]}}}}" if port in valid else f"{{{port.width}{{1'b1}}}}"
        for port in reversed(outputs)
    ]
    bits = total_width(outputs)
    return f"""{TIMESCALE}module ReplayBench;
  reg clk = 0, fresh;
  reg [{total_width(inputs) - 1}:0] in;
  reg [{bits - 1}:0] want;
  wire [{bits - 1}:0] got;
  wire [{bits - 1}:0] care = {{{", ".join(care)}}};
{instance(top, ports)}
  integer file, cycle = 0;
  reg [8*1024-1:0] name;
  initial begin
    if (!$value$plusargs("trace=%s", name)) $fatal(1, "+trace=FILE is missing");
    file = $fopen(name, "r");
    if (file == 0) $fatal(1, "+trace: cannot be read");
    while ($fscanf(file, "%b %h %h", fresh, in, want) == 3) begin
      #40;
      if (!fresh && (((got ^ want) & care) !== {bits}'b0 || ^got === 1'bx)) begin
        $display("MISMATCH %0d %b %b", cycle, want, got);
        $finish;
      end
      clk = 1;
      #50 clk = 0;
      #10 cycle = cycle + 1;
    end
    $display("END %0d", cycle);
    $finish;
  end
endmodule
"""


def replay_files(
    traces: Sequence[Path | str],
    verilog: Sequence[Path],
    top: str | None = None,
    cells: Sequence[Path] = (),
    strict: bool = False,
    seconds: float = SECONDS,
) -> list[Mismatch]:
    """Drive recorded traces into Verilog; returns the mismatches of the first cycle that differs, [] if none does.

    traces: .json files of Trace.save, of one parameter set or of modules with the same ports and behaviour.
    verilog, cells: files. top: their module, by default the traces' class. seconds: limit of a simulation.
    One compilation, then a run a trace. Raises IcarusError if the Verilog does not compile or ends early.
    """
    heads = [(Path(path), load(path, cycles=False)) for path in traces]
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        program = Path(folder) / "replay.vvp"
        compile_program(
            program, [*verilog, *cells], "ReplayBench", [bench(top or heads[0][1].cls, heads[0][1].ports, strict)]
        )
        for path, head in heads:
            if mismatches := _run(program, path, head, strict, seconds):
                return mismatches
    return []


def replay(trace: Trace, verilog: Sequence[Path], **options: Any) -> list[Mismatch]:
    """Drive a Trace in memory into Verilog. Options: see `replay_files`."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        return replay_files([trace.save(folder)], verilog, **options)


def _run(program: Path, path: Path, head: Trace, strict: bool, seconds: float) -> list[Mismatch]:
    command = ["vvp", "-n", program, f"+trace={path.with_suffix('.trace')}"]
    try:
        result = finish(command, seconds=seconds)
    except ToolTimeout:
        return [Mismatch(head.cls, 0, "simulation", "an end", f"none after {seconds} s")]
    verdict = result.stdout.split("\n")
    verdict = next((line.split() for line in verdict if line.startswith(("MISMATCH ", "END "))), None)
    if result.returncode or not verdict:
        raise IcarusError(f"the replay of {path.stem} ended early:\n{(result.stdout + result.stderr).strip()[-2000:]}")
    if verdict[0] == "END":
        if int(verdict[1]) != head.cycles:
            raise IcarusError(f"the replay of {path.stem} read {verdict[1]} of {head.cycles} cycles")
        return []
    cycle, want, got = verdict[1:]
    return _differences(head, int(cycle), want, got, strict)


def _differences(head: Trace, cycle: int, want: str, got: str, strict: bool) -> list[Mismatch]:
    """Return the ports that differ in ``cycle``; want, got: packed outputs in binary, highest bit first."""
    outputs, out = split(head.ports)[1], []
    valid = {} if strict else validity(head.ports)
    value = {
        port: tuple(bits[::-1][low : low + port.width][::-1] for bits in (want, got))
        for port, low in places(outputs).items()
    }
    for port, (expected, actual) in value.items():
        matters = port not in valid or value[valid[port]][0] == "1"
        if actual.strip("01") or matters and actual != expected:
            out.append(Mismatch(head.test_at(cycle), cycle, port.name, expected, actual))
    return out
