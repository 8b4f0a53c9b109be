"""A module driven in Icarus: programs compiled once, and a simulation that answers inputs with outputs.

Icarus is event-driven and 4-state: what a register holds before its reset is X here, and an X that a port shows
after reset is an error.
"""

import contextlib
import hashlib
import os
import shutil
import subprocess
import tempfile
import weakref
from pathlib import Path

from rtl.ports import places, split, total_width

PROGRAMS = Path(__file__).parents[1] / "build" / "icarus"
MISSING = "iverilog: not found; install it with: make tools (Debian: apt-get install iverilog)"
TIMESCALE = "`timescale 1ns/1ps\n"


class IcarusError(RuntimeError):
    """Icarus is missing, refused a file or ended early; the message holds what it said."""


def installed():
    return bool(shutil.which("iverilog") and shutil.which("vvp"))


def instance(top, ports):
    """Verilog of an instance `dut` of module ``top`` between clk, `in` and `got`, packed as ``rtl.ports.places``."""
    pins = [".clk(clk)"]
    for group, vector in zip(split(ports), ("in", "got")):
        pins += [f".{port.name}({vector}[{low} +: {port.width}])" for port, low in places(group).items()]
    return f"  {top} dut (\n    " + ",\n    ".join(pins) + "\n  );\n"


def driven(top, ports):
    """Verilog of a bench that takes a line of inputs from stdin and writes the outputs, in binary, to stdout.

    A line: 1 for a clock edge ahead of the new inputs or 0, and the inputs in hexadecimal.
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


def compile_program(program, sources, top, texts=()):
    """Compile module ``top`` of the Verilog files ``sources`` and the Verilog ``texts`` to ``program``, a path.

    Raises IcarusError.
    """
    if not installed():
        raise IcarusError(MISSING)
    program.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        files = [f"{folder}/text{number}.v" for number in range(len(texts))]
        for file, text in zip(files, texts):
            Path(file).write_text(text)
        files += map(str, sources)  # behind the bench: its time scale is that of cells that have none
        part = program.with_name(f".{program.name}.part-{os.getpid()}")
        result = subprocess.run(
            ["iverilog", "-g2012", "-s", top, "-o", part, *files], capture_output=True, text=True, timeout=300
        )
        if result.returncode:
            raise IcarusError(f"iverilog refused {top}:\n{(result.stdout + result.stderr).strip()[-2000:]}")
        os.replace(part, program)


def kept_program(name, sources, top, texts=()):
    """As `compile_program`, to a file that is kept for the same sources and texts: its path."""
    digest = hashlib.sha256(top.encode())
    for part in (*(Path(source).read_bytes() for source in sources), *(text.encode() for text in texts)):
        digest.update(len(part).to_bytes(8, "big") + part)
    program = PROGRAMS / f"{name}.{digest.hexdigest()[:16]}.vvp"
    if not program.exists():
        compile_program(program, sources, top, texts)
    return program


class Driven:
    """A simulation that is asked line by line: `step` gives it inputs and takes its outputs, as packed numbers.

    command: of a program that answers lines as `driven` does.
    """

    def __init__(self, command, ports):
        self.outputs = split(ports)[1]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._end = weakref.finalize(self, _end, self.process)
        self.send, self.flush = self.process.stdin.write, self.process.stdin.flush
        self.receive = self.process.stdout.readline

    def step(self, edge, inputs):
        """Settled outputs for ``inputs``, after a clock edge with the old ones if ``edge``: text of 0, 1, x and z."""
        try:
            self.send(b"%d %x\n" % (edge, inputs))
            self.flush()
        except BrokenPipeError:
            pass  # what it said stands in what is left to read
        line = self.receive()
        if not line or line.strip(b"01xz\n"):
            said = line + self.process.stdout.read(2000)
            said = said.decode(errors="replace").strip() or "it said nothing"
            raise IcarusError(f"the simulation ended early: {said}")
        return line

    def unknown(self, line):
        """The ports that show X or Z in an answer: list of str, 'recv__rdy = x'."""
        bits = line.decode().strip()[::-1]
        values = {port.name: bits[low : low + port.width][::-1] for port, low in places(self.outputs).items()}
        return [f"{name} = {value}" for name, value in values.items() if value.strip("01")]


def _end(process):
    with contextlib.suppress(OSError):
        process.stdin.close()
    process.kill()
    process.wait()
    process.stdout.close()
