"""The subcircuit of a laid-out cell as SPICE text."""

from collections.abc import Sequence
from pathlib import Path

from talbot.cells.extract.capacitance import capacitances
from talbot.cells.extract.devices import find
from talbot.cells.extract.resistance import Resistances, resistances
from talbot.models.parameters import ParameterError
from talbot.platforms.extraction import ExtractionPlatform

SMALLEST = 1e-4  # fF; less is left out


def extract(
    gds: str | Path,
    name: str,
    tech: ExtractionPlatform,
    ports: Sequence[str] = (),
    capacitors: bool = True,
    resistors: bool = True,
) -> str:
    """SPICE text of cell ``name`` in the file ``gds``: transistors in um and um2, capacitors in fF, resistors in ohm.

    ports: their names in order; without it they come from the netlist next to the GDS (same name, .spice or .spi), else
    sorted. Raises ParameterError when GDS, cell or ports do not fit.
    """
    layout = find(gds, name, tech)
    ports = tuple(ports or _schematic_ports(Path(gds), name) or sorted(layout.ports))
    if set(ports) != layout.ports:
        raise ParameterError(
            f"ports = {' '.join(ports)}: must be those labelled in {gds}, cell {name}: {' '.join(sorted(layout.ports))}"
        )
    lines = [f".subckt {name} {' '.join(ports)}"]
    ohmic = resistances(layout, tech) if resistors else Resistances([], {})
    for i, d in enumerate(layout.devices):
        at = {"drain": d.drain, "gate": d.gate, "source": d.source, **ohmic.terminals.get(i, {})}
        lines.append(
            f"X{i} {at['drain']} {at['gate']} {at['source']} {d.bulk} {tech.model(d.kind, d.width, d.marks)} "
            f"w={d.width:.4g} l={d.length:.4g} ad={d.ad:.4g} as={d.as_:.4g} pd={d.pd:.4g} ps={d.ps:.4g} "
            f"sa={d.sa:.4g} sb={d.sb:.4g}"
        )
    if capacitors:
        pairs = sorted(capacitances(layout, tech).items())
        lines += [f"C{i} {a} {b} {value:.4f}f" for i, ((a, b), value) in enumerate(pairs) if value >= SMALLEST]
    lines += [f"R{i} {a} {b} {value:.5g}" for i, (a, b, value) in enumerate(ohmic.resistors)]
    return "\n".join([*lines, ".ends", ""])


def _schematic_ports(gds: Path, name: str) -> list[str]:
    for suffix in (".spice", ".spi"):
        beside = gds.with_suffix(suffix)
        if beside.exists():
            for line in beside.read_text(encoding="utf-8").replace("\n+", " ").splitlines():
                words = line.split()
                if words[:1] and words[0].lower() == ".subckt" and words[1] == name:
                    return [word for word in words[2:] if "=" not in word]
    return []
