"""The ports of an elaborated component as its Verilog names them, and their values packed into one number."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from pymtl3 import Bits, Component, InPort, OutPort


@dataclass(frozen=True)
class Port:
    """A port of a component at ``path``, 'recv.msg', ``width`` bits wide; struct: a bit struct, not Bits."""

    path: str
    width: int
    output: bool
    struct: bool = False

    @property
    def name(self) -> str:
        """Return its name in the Verilog, 'recv__msg'."""
        return self.path.replace(".", "__")


def port_signals(component: Component) -> list[InPort | OutPort]:
    """Yield every port of an elaborated component, those of its interfaces too."""
    return [
        signal
        for signal in component.get_all_object_filter(lambda x: isinstance(x, (InPort, OutPort)))
        if signal.get_host_component() is component and signal.is_top_level_signal()
    ]


def ports_of(component: Component) -> tuple[Port, ...]:
    """Return every port of an elaborated component but clk: inputs first, each group by name."""
    start, ports = len(repr(component)) + 1, []
    for signal in port_signals(component):
        kind = signal._dsl.Type
        ports.append(Port(repr(signal)[start:], kind.nbits, isinstance(signal, OutPort), not issubclass(kind, Bits)))
    return tuple(sorted((p for p in ports if p.path != "clk"), key=lambda p: (p.output, p.path)))


def split(ports: Sequence[Port]) -> tuple[tuple[Port, ...], tuple[Port, ...]]:
    """Return the inputs and the outputs."""
    return tuple(p for p in ports if not p.output), tuple(p for p in ports if p.output)


def places(ports: Iterable[Port]) -> dict[Port, int]:
    """Return the lowest bit of each port in the packed value, the first port lowest."""
    out, low = {}, 0
    for port in ports:
        out[port] = low
        low += port.width
    return out


def total_width(ports: Iterable[Port]) -> int:
    """Return the width of the packed value, at least 1."""
    return max(1, sum(port.width for port in ports))


def validity(ports: Iterable[Port]) -> dict[Port, Port]:
    """Return the `val` of each output stream's `msg`."""
    named = {port.path: port for port in ports if port.output}
    pairs = ((port, named.get(path[:-3] + "val")) for path, port in named.items() if path.endswith(".msg"))
    return {msg: val for msg, val in pairs if val}


def packed(ports: Iterable[Port], component: str = "s") -> str:
    """Return the source of an expression that packs the ``ports`` of the variable named ``component``."""
    parts = []
    for port, low in places(ports).items():
        value = f"int({component}.{port.path}{'.to_bits()' if port.struct else ''})"
        parts.append(f"{value} << {low}" if low else value)
    return " | ".join(parts) or "0"
