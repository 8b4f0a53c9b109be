"""A circuit without hierarchy, and its text for LVS."""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from talbot.pixels.circuits.netlist import Capacitor, Circuit, Resistor, Transistor
from talbot.platforms.analog import AnalogMasks


class Plate(NamedTuple):
    """A capacitor's plates: nets of the upper and the lower one, um2, um of the edge."""

    name: str
    upper: str
    lower: str
    area: float
    edge: float


class Tap(NamedTuple):
    """The point where some units of a capacitor meet their net, um."""

    name: str
    units: float
    x: float
    y: float


class Ends(NamedTuple):
    """The points where a resistor's two ends meet the first metal, um."""

    name: str
    first: tuple[float, float]
    last: tuple[float, float]


def transistors(circuit: Circuit, prefix: str = "", nets: Mapping[str, str] | None = None) -> Iterator[Transistor]:
    """All transistors, those of inner circuits with names and nets like ``arm.tail``."""
    known = {} if nets is None else nets

    def net(name: str) -> str:
        return known.get(name, prefix + name)

    for t in circuit.transistors:
        yield t._replace(
            name=prefix + t.name, drain=net(t.drain), gate=net(t.gate), source=net(t.source), bulk=net(t.bulk)
        )
    for instance in circuit.instances:
        inner = dict(zip(instance.circuit.ports, map(net, instance.nodes), strict=True))
        yield from transistors(instance.circuit, f"{prefix}{instance.name}.", inner)


def capacitors(circuit: Circuit, prefix: str = "", nets: Mapping[str, str] | None = None) -> Iterator[Capacitor]:
    """All capacitors of matched cells, named as `transistors` are; assumed parasitics are left out."""
    known = {} if nets is None else nets
    for c in circuit.capacitors:
        if c.units:
            yield c._replace(name=prefix + c.name, a=known.get(c.a, prefix + c.a), b=known.get(c.b, prefix + c.b))
    for instance in circuit.instances:
        inner = {p: known.get(n, prefix + n) for p, n in zip(instance.circuit.ports, instance.nodes, strict=True)}
        yield from capacitors(instance.circuit, f"{prefix}{instance.name}.", inner)


def spice(
    name: str,
    ports: Iterable[str],
    devices: Iterable[Transistor],
    masks: AnalogMasks,
    plates: Iterable[Plate] = (),
    resistors: Iterable[Resistor] = (),
    fringes: Mapping[tuple[str, str], int] | None = None,
) -> str:
    """Return the text for LVS. plates: of its capacitors. fringes: units between two nets."""
    lines = [f".subckt {name} {' '.join(ports)}"]
    lines += [
        f"M{t.name} {t.drain} {t.gate} {t.source} {t.bulk} {masks.models[t.role]} W={t.w:.6g}U L={t.l:.6g}U"
        for t in devices
    ]
    lines += [
        f"C{c} {upper} {lower} {2e-15 * area:.6g} {masks.deck_mim} A={area:.6g}P P={edge:.6g}U"
        for c, upper, lower, area, edge in plates
    ]
    side = masks.fringe_side_um
    lines += [
        f"Cfringe.{a}.{b} {a} {b} {1e-15 * area:.6g} {masks.deck_fringe} A={area:.6g}P P={4 * area / side:.6g}U"
        for (a, b), area in ((nets, n * side**2) for nets, n in (fringes or {}).items())
    ]
    lines += [f"R{r.name} {r.a} {r.b} {r.value:.6g} {masks.deck_resistor}" for r in resistors]
    return "\n".join([*lines, f".ends {name}", ""])
