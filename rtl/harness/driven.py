"""A component whose behaviour is a simulation in a child process, with the ports of the component that it replaces."""

import contextlib
import linecache
import subprocess
import weakref
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from pymtl3 import Component, InPort, Interface, OutPort, mk_bits, update, update_ff

from talbot.base.tools import ToolError

from .ports import Port, places, port_signals, ports_of, split

SOURCE = """
def behaviour(s, evaluate, clock):
  @update
  def up_module():
    answer = evaluate({inputs})
    if answer:
{outputs}

  @update_ff
  def up_clock():
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
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._end = weakref.finalize(self, _end, self.process)
        self.send, self.flush = self.process.stdin.write, self.process.stdin.flush
        self.receive = self.process.stdout.readline

    def step(self, edge: bool, inputs: int) -> bytes:
        """Settled outputs for the packed ``inputs``: binary text of 0, 1, x and z.

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
        """The ports that are X or Z in an answer of `step`: 'recv__rdy = x'."""
        bits = line.decode().strip()[::-1]
        values = {port.name: bits[low : low + port.width][::-1] for port, low in places(self.outputs).items()}
        return [f"{name} = {value}" for name, value in values.items() if value.strip("01")]


def _end(process: subprocess.Popen) -> None:
    with contextlib.suppress(OSError):
        process.stdin.close()
    process.kill()
    process.wait()
    process.stdout.close()


class Transactor:
    """Inputs and clock edges of a component sent to its simulation; kinds: bit struct of a port, by its path."""

    def __init__(self, simulation: Driven, ports: Sequence[Port], kinds: Mapping[str, Any]) -> None:
        inputs, outputs = split(ports)
        self.simulation, self.cycle, self.edge = simulation, 0, False
        self.inputs: int | None = None
        self.answer: int | None = None
        self.low = tuple(places(inputs).values())
        self.take = [
            (low, (1 << port.width) - 1, kinds[port.path] if port.struct else None, mk_bits(port.width))
            for port, low in places(outputs).items()
        ]

    def clock(self) -> None:
        """Note a clock edge; it is sent ahead of the next inputs."""
        self.edge = True
        self.cycle += 1

    def evaluate(self, *values: Any) -> tuple[Any, ...]:
        """Values of the outputs for those of the inputs, each in the order of the ports; () where none has changed."""
        inputs = 0
        for value, low in zip(values, self.low):
            inputs |= int(value if hasattr(value, "uint") else value.to_bits()) << low
        if inputs == self.inputs and not self.edge:
            return ()
        line = self.simulation.step(self.edge, inputs)
        self.inputs, self.edge = inputs, False
        try:
            answer = int(line, 2)
        except ValueError:
            # Registers hold X until the first clock edge of the first reset, and not a cycle longer
            assert self.cycle == 0, f"cycle {self.cycle}: {', '.join(self.simulation.unknown(line))}"
            answer = 0
        if answer == self.answer:
            return ()
        self.answer = answer
        return tuple(
            kind.from_bits(bits(answer >> low & mask)) if kind else answer >> low & mask
            for low, mask, kind, bits in self.take
        )


class DrivenLevel(Component):
    """A component with the ``ports`` of the elaborated component ``dut``, and its simulation's behaviour."""

    def construct(
        s, dut: Component, ports: Sequence[Port], evaluate: Callable[..., tuple[Any, ...]], clock: Callable[[], None]
    ) -> None:
        # Interface
        for attribute, what in list(vars(dut).items()):
            if isinstance(what, (InPort, OutPort)) and attribute not in ("clk", "reset"):
                setattr(s, attribute, type(what)(what._dsl.Type))
            elif isinstance(what, Interface):
                setattr(s, attribute, type(what)(*what._dsl.args, **what._dsl.kwargs))

        # Logic: written out, since PyMTL schedules by the source of a block
        inputs, outputs = split(ports)
        source = SOURCE.format(
            inputs=", ".join(f"s.{port.path}" for port in inputs),
            outputs="\n".join(f"      s.{port.path} @= answer[{i}]" for i, port in enumerate(outputs)),
        )
        file = f"<ports of {type(dut).__name__} {hash(ports):x}>"
        linecache.cache[file] = len(source), None, source.splitlines(keepends=True), file
        scope = {"update": update, "update_ff": update_ff}
        exec(compile(source, file, "exec"), scope)
        scope["behaviour"](s, evaluate, clock)

    def line_trace(s) -> str:
        return ""


def driven_level(dut: Component, simulation: Driven) -> DrivenLevel:
    """The DrivenLevel that replaces the elaborated component ``dut`` by ``simulation``."""
    ports, start = ports_of(dut), len(repr(dut)) + 1
    kinds = {repr(signal)[start:]: signal._dsl.Type for signal in port_signals(dut)}
    cls = type(f"{type(dut).__name__}Driven", (DrivenLevel,), {})  # PyMTL caches a class's blocks by the class
    transactor = Transactor(simulation, ports, kinds)
    return cls(dut, ports, transactor.evaluate, transactor.clock)
