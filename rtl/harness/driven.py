"""A component whose behaviour is a Verilog module in Icarus, behind the ports of the component that it replaces."""

import linecache
from pathlib import Path

from pymtl3 import Component, InPort, Interface, OutPort, mk_bits, update, update_ff

from rtl.export import translate_component
from rtl.icarus import Driven, IcarusError, driven, kept_program
from rtl.ports import places, port_signals, ports_of, split

# Netlists that stand for the translated Verilog of what `rtl.testbench.build` is given by this name: dict name ->
# (file, module or None for the class's name), the models of their cells, and the names that were asked for.
netlists, cells, asked = {}, [], set()

SOURCE = """
def behaviour(s, evaluate, clock):
  @update
  def up_module():
    answer = evaluate({inputs})
{outputs}

  @update_ff
  def up_clock():
    clock()
"""


def program(dut, name):
    """The compiled Verilog of the elaborated component ``dut``, or the netlist for ``name``. Raises IcarusError."""
    cls, ports = type(dut), ports_of(dut)
    asked.add(name)
    if name in netlists:
        path, module = netlists[name]
        if not Path(path).is_file():
            raise IcarusError(f"netlist = {path}: no such file")
        return kept_program(name, [path, *cells], "DrivenBench", [driven(module or cls.__name__, ports)])
    text = translate_component(cls(*dut._dsl.args, **dut._dsl.kwargs), cls.__name__)
    return kept_program(name, [], "DrivenBench", [driven(cls.__name__, ports), text])


class Conversation:
    """What the component says to its simulation: new inputs, and clock edges ahead of them."""

    def __init__(self, simulation, ports, kinds):
        inputs, outputs = split(ports)
        self.simulation, self.cycle, self.edge, self.inputs = simulation, 0, False, None
        self.low = tuple(places(inputs).values())
        self.take = [
            (low, (1 << port.width) - 1, kinds[port.path] if port.struct else None, mk_bits(port.width))
            for port, low in places(outputs).items()
        ]

    def clock(self):
        self.edge = True
        self.cycle += 1

    def evaluate(self, *values):
        """Values of the outputs for those of the inputs, each in the order of the ports."""
        inputs = 0
        for value, low in zip(values, self.low):
            inputs |= int(value if hasattr(value, "uint") else value.to_bits()) << low
        if inputs != self.inputs or self.edge:
            line = self.simulation.step(self.edge, inputs)
            self.inputs, self.edge = inputs, False
            try:
                answer = int(line, 2)
            except ValueError:
                # Registers hold X until the first clock edge of the first reset, and not a cycle longer
                assert self.cycle == 0, f"cycle {self.cycle}: {', '.join(self.simulation.unknown(line))}"
                answer = 0
            self.answer = tuple(
                kind.from_bits(bits(answer >> low & mask)) if kind else answer >> low & mask
                for low, mask, kind, bits in self.take
            )
        return self.answer


def in_icarus(dut, name):
    """Command of the simulation of ``dut``; name: see `program`."""
    return ["vvp", "-n", program(dut, name)]


start = in_icarus  # another simulator's takes its place for netlists (conftest.py)


def icarus_level(dut, name):
    """The DrivenLevel for the elaborated component ``dut`` in Icarus; name: see `program`."""
    return driven_level(dut, Driven(start(dut, name), ports_of(dut)))


def driven_level(dut, simulation):
    """The DrivenLevel for the elaborated component ``dut`` with the behaviour of ``simulation``, a Driven."""
    ports, start = ports_of(dut), len(repr(dut)) + 1
    kinds = {repr(signal)[start:]: signal._dsl.Type for signal in port_signals(dut)}
    cls = type(f"{type(dut).__name__}Driven", (DrivenLevel,), {})  # PyMTL keeps what it knows of blocks by class
    return cls(dut, ports, Conversation(simulation, ports, kinds))


class DrivenLevel(Component):
    """dut: the elaborated component whose ``ports`` this one has. talk: Conversation with its simulation."""

    def construct(s, dut, ports, talk):
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
            outputs="\n".join(f"    s.{port.path} @= answer[{i}]" for i, port in enumerate(outputs)),
        )
        file = f"<ports of {type(dut).__name__} {hash(ports):x}>"
        linecache.cache[file] = len(source), None, source.splitlines(keepends=True), file
        scope = {"update": update, "update_ff": update_ff}
        exec(compile(source, file, "exec"), scope)
        scope["behaviour"](s, talk.evaluate, talk.clock)

    def line_trace(s):
        return ""
