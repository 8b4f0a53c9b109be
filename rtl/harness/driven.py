"""A component with the ports of the one that it replaces, and the behaviour of an external simulation."""

import contextlib
import linecache
import subprocess
import weakref
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from pymtl3 import Component, InPort, Interface, OutPort, Wire, mk_bits, update, update_ff

from talbot.base.environment import of_tools
from talbot.base.tools import ToolError
from talbot.rtl.harness.ports import Port, places, port_signals, ports_of, split

SOURCE = """
def pack({names}):
  return {packed}

def behaviour(s, evaluate, clock):
  s.edges = Wire()

  @update
  def up_module():
    answer, changed = evaluate(s.edges, pack({inputs}))
{outputs}

  @update_ff
  def up_clock():
    s.edges <<= ~s.edges
    clock()
"""


class SimulationError(ToolError):
    """A simulation ended early; the message holds its output."""


class Driven:
    """A simulation in a child process: `step` sends a line of inputs and reads the line of outputs.

    command: a program that answers lines as the bench of `rtl.harness.icarus.driven_bench` does.
    """

    def __init__(self, command: Sequence[str | Path], ports: Sequence[Port]) -> None:
        self.outputs = split(ports)[1]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=of_tools())
        self._end = weakref.finalize(self, _end, self.process)
        self.send, self.flush = self.process.stdin.write, self.process.stdin.flush
        self.receive = self.process.stdout.readline

    def step(self, edge: bool, inputs: int) -> bytes:
        """Return the settled outputs for the packed ``inputs``: binary text of 0, 1, x and z.

        edge: a clock edge with the old inputs comes first. Raises SimulationError.
        """
        try:
            self.send(b"%d %x\n" % (edge, inputs))
            self.flush()
        except BrokenPipeError:
            pass  # its message is in the output that is not read yet
        line = self.receive()
        if not line or line.strip(b"01xz\n"):
            output = line + self.process.stdout.read(2000)
            output = output.decode(errors="replace").strip() or "no output"
            raise SimulationError(f"the simulation ended early: {output}")
        return line

    def unknown(self, line: bytes) -> list[str]:
        """Return the ports that are X or Z in an answer of `step`: 'recv__rdy = x'."""
        bits = line.decode().strip()[::-1]
        values = {port.name: bits[low : low + port.width][::-1] for port, low in places(self.outputs).items()}
        return [f"{name} = {value}" for name, value in values.items() if value.strip("01")]


def _end(process: subprocess.Popen) -> None:
    with contextlib.suppress(OSError):
        process.stdin.close()
    process.kill()
    process.wait()
    process.stdout.close()


class Simulation(Protocol):
    """A simulation of a component: `step` as in Driven, with outputs as binary text or as a number."""

    def step(self, edge: bool, inputs: int) -> bytes | int:
        """Return the settled outputs for the packed ``inputs``; edge: a clock edge with the old inputs comes first."""
        ...


class Transactor:
    """Sends inputs and clock edges of a component to its simulation."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation, self.cycle, self.edge = simulation, 0, False
        self.inputs: int | None = None
        self.answer: int | None = None

    def clock(self) -> None:
        """Note a clock edge; it is sent ahead of the next inputs."""
        self.edge = True
        self.cycle += 1

    def evaluate(self, _edges: Any, inputs: int) -> tuple[int, int]:
        """Return the packed outputs for the packed ``inputs``, and the bits of them that may have changed."""
        if inputs == self.inputs and not self.edge:
            return 0, 0
        answer = self.simulation.step(self.edge, inputs)
        self.inputs, self.edge = inputs, False
        if isinstance(answer, bytes):
            answer = self._number(answer)
        changed = -1 if self.answer is None else answer ^ self.answer
        self.answer = answer
        return answer, changed

    def _number(self, line: bytes) -> int:
        try:
            return int(line, 2)
        except ValueError:
            # Registers hold X until the first clock edge of the first reset, and not a cycle longer
            assert self.cycle == 0, f"cycle {self.cycle}: {', '.join(self.simulation.unknown(line))}"
            return 0


class DrivenLevel(Component):
    """A component with the ``ports`` of the elaborated component ``dut``, and the behaviour of ``simulation``.

    kinds: bit struct of a port, by its path.
    """

    def construct(s, dut: Component, ports: Sequence[Port], kinds: Mapping[str, Any], simulation: Simulation) -> None:
        # Interface
        for attribute, value in list(vars(dut).items()):
            if isinstance(value, (InPort, OutPort)) and attribute not in ("clk", "reset"):
                setattr(s, attribute, type(value)(value._dsl.Type))
            elif isinstance(value, Interface):
                setattr(s, attribute, type(value)(*value._dsl.args, **value._dsl.kwargs))

        # Logic: written out, since PyMTL schedules by the source of a block
        inputs, outputs = split(ports)
        source = SOURCE.format(
            names=", ".join(port.name for port in inputs),
            packed=" | ".join(
                f"{port.name}{'.to_bits()' * port.struct}._uint << {low}" for port, low in places(inputs).items()
            ),
            inputs=", ".join(f"s.{port.path}" for port in inputs),
            outputs="\n".join(_output(port, low) for port, low in places(outputs).items()),
        )
        file = f"<ports of {type(dut).__name__} {hash(ports):x}>"
        linecache.cache[file] = len(source), None, source.splitlines(keepends=True), file
        scope: dict[str, Any] = {"update": update, "update_ff": update_ff, "Wire": Wire}
        scope |= {f"struct_{port.name}": _struct(kinds[port.path], port.width) for port in outputs if port.struct}
        exec(compile(source, file, "exec"), scope)
        transactor = Transactor(simulation)
        scope["behaviour"](s, transactor.evaluate, transactor.clock)

    def line_trace(s) -> str:
        return ""


def _output(port: Port, low: int) -> str:
    """Return the source that sets an output to its bits of ``answer``, where one of them has ``changed``."""
    mask = (1 << port.width) - 1
    value = f"struct_{port.name}" * port.struct + f"(answer >> {low} & {mask:#x})"
    return f"    if changed & {mask << low:#x}:\n      s.{port.path} @= {value}"


def _struct(kind: Any, width: int) -> Callable[[int], Any]:
    bits = mk_bits(width)
    return lambda number: kind.from_bits(bits(number))


def driven_level(dut: Component, simulation: Simulation) -> DrivenLevel:
    """Return the DrivenLevel that replaces the elaborated component ``dut`` by ``simulation``."""
    ports, start = ports_of(dut), len(repr(dut)) + 1
    kinds = {repr(signal)[start:]: signal._dsl.Type for signal in port_signals(dut)}
    cls = type(f"{type(dut).__name__}Driven", (DrivenLevel,), {})  # PyMTL caches a class's blocks by the class
    return cls(dut, ports, kinds, simulation)
