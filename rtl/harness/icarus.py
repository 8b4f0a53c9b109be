"""Verilog in Icarus: programs compiled once, and a module driven line by line.

Icarus is event-driven and 4-state: a register is X before its reset, and an X at a port after reset is an error.
"""

import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path

from talbot.base.cache import cached, digest
from talbot.base.files import atomic
from talbot.base.paths import BUILD
from talbot.base.tools import finish
from talbot.rtl.harness.driven import Driven, SimulationError
from talbot.rtl.harness.ports import Port, places, split, total_width

PROGRAMS, PROGRAM = BUILD / "icarus", "program.vvp"
MISSING = "iverilog: not found; install it with: make tools (Debian: apt-get install iverilog)"
TIMESCALE = "`timescale 1ns/1ps\n"


class IcarusError(SimulationError):
    """Icarus is missing, refused a file or ended early; the message holds its output."""


def installed() -> bool:
    """True if Icarus is installed."""
    return bool(shutil.which("iverilog") and shutil.which("vvp"))


def instance(top: str, ports: Sequence[Port]) -> str:
    """Return Verilog of an instance `dut` of module ``top`` between clk, `in` and `got`, packed as by `places`."""
    pins = [".clk(clk)"]
    for group, vector in zip(split(ports), ("in", "got")):
        pins += [f".{port.name}({vector}[{low} +: {port.width}])" for port, low in places(group).items()]
    return f"  {top} dut (\n    " + ",\n    ".join(pins) + "\n  );\n"


def driven_bench(top: str, ports: Sequence[Port]) -> str:
    """Verilog of module DrivenBench: it reads a line of inputs from stdin and writes the outputs of ``top`` to stdout.

    A line of inputs: 1 for a clock edge ahead of the new inputs or 0, and the inputs in hexadecimal. Outputs: binary.
    """
    inputs, outputs = split(ports)
    return f"""{TIMESCALE}module DrivenBench;
  reg clk = 0, edge_first;
  reg [{total_width(inputs) - 1}:0] in, next;
  wire [{total_width(outputs) - 1}:0] got;
{instance(top, ports)}
  initial begin
    while ($fscanf(32'h8000_0000, "%b %h", edge_first, next) == 2) begin
      if (edge_first) begin
        clk = 1;
        #50 clk = 0;
      end
      in = next;
      #50 $display("%b", got);
      $fflush;
    end
    $finish;
  end
endmodule
"""


def compile_program(program: Path, sources: Sequence[Path], top: str, texts: Sequence[str] = (), *more: str) -> None:
    """Compile module ``top`` of the Verilog files ``sources`` and the Verilog ``texts`` to the file ``program``.

    more: further top modules. Raises IcarusError.
    """
    if not installed():
        raise IcarusError(MISSING)
    program.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        files = [f"{folder}/text{number}.v" for number in range(len(texts))]
        for file, text in zip(files, texts):
            Path(file).write_text(text, encoding="utf-8")
        files += map(str, sources)  # after the bench: cells without a time scale take the bench's
        with atomic(program) as part:
            roots = [word for root in (top, *more) for word in ("-s", root)]
            result = finish(["iverilog", "-g2012", *roots, "-o", part, *files], seconds=300)
            if result.returncode:
                raise IcarusError(f"iverilog refused {top}:\n{(result.stdout + result.stderr).strip()[-2000:]}")


def kept_program(name: str, sources: Sequence[Path], top: str, texts: Sequence[str] = ()) -> Path:
    """Return the program of `compile_program`, kept for the same sources and texts. Raises IcarusError."""
    folder = PROGRAMS / f"{name}.{digest(top, *map(Path, sources), *texts)}"
    return cached(folder, lambda part: compile_program(part / PROGRAM, sources, top, texts)) / PROGRAM


def in_icarus(
    name: str, top: str, ports: Sequence[Port], sources: Sequence[Path] = (), texts: Sequence[str] = ()
) -> Driven:
    """Start module ``top`` of ``sources`` and ``texts`` in Icarus; name: of its program. Raises IcarusError."""
    return Driven(["vvp", "-n", kept_program(name, sources, "DrivenBench", [driven_bench(top, ports), *texts])], ports)
