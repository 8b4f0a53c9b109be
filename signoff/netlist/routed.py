"""A routed design as OpenROAD's DEF has it: netlist, places, straps, routes."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from talbot.base.steps import StepError
from talbot.signoff.netlist.netlist import DIODE, Instance, Netlist, Port

# DEF's orientations: the number that `placed.TURNS` has, and whether the cell's origin is at its right, and its top
ORIENTATIONS = {"N": ("0", 0, 0), "S": ("2", 1, 1), "FN": ("4", 1, 0), "FS": ("6", 0, 1)}
ROW = re.compile(r"(?m)^ROW \S+ \S+ (\S+) (\S+) \S+ DO (\d+) BY 1 STEP (\d+) 0")
COMPONENT = re.compile(r"- (\S+) (\S+) .*?\+ (?:PLACED|FIXED) \( (\S+) (\S+) \) (\w+)")
SEGMENT = re.compile(r"(?:\+ ROUTED|NEW) (\S+)(?: TAPER)? ([^+;]*?)(?=\bNEW\b|[+;]|$)")
STRAP = re.compile(r"(?:\+ ROUTED|NEW) (\S+) (\d+) \+ SHAPE STRIPE \( (\S+) (\S+) \) \( (\S+) (\S+) \)")


@dataclass(frozen=True)
class Component:
    """An instance. at_um: of its lower left corner. orientation: DEF's."""

    name: str
    cell: str
    at_um: tuple[float, float]
    orientation: str
    pins: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Routed:
    """A routed design.

    size_um: width and height. core_um: box of the rows. straps: (net, x in um) of every vertical strap. wire_um: length
    of all nets' segments without those of the supplies. vias: of these nets.
    """

    size_um: tuple[float, float]
    core_um: tuple[float, float, float, float]
    components: tuple[Component, ...]
    straps: tuple[tuple[str, float], ...]
    wire_um: float
    vias: int

    @classmethod
    def read(cls, path: Path, strap: str, row_um: float) -> "Routed":
        """Read a DEF file. strap: layer of the vertical straps. Raises StepError for a file that is none."""
        text = path.read_text(encoding="utf-8")
        unit = re.search(r"UNITS DISTANCE MICRONS (\d+)", text)
        area = re.search(r"DIEAREA \( (\S+) (\S+) \) \( (\S+) (\S+) \)", text)
        if not unit or not area:
            raise StepError(f"{path}: must be a DEF file with UNITS and DIEAREA")
        um = 1 / int(unit[1])
        rows = [[int(value) * um for value in found] for found in ROW.findall(text)]
        if not rows:
            raise StepError(f"{path}: must have rows")
        west, south, north = min(row[0] for row in rows), min(row[1] for row in rows), max(row[1] for row in rows)
        east = max(row[0] + row[2] * row[3] / um for row in rows)
        core = round(west, 4), round(south, 4), round(east, 4), round(north + row_um, 4)
        left, bottom, right, top = (int(value) * um for value in area.groups())
        components: dict[str, Component] = {}
        for statement in _statements(text, "COMPONENTS"):
            if found := COMPONENT.search(statement):
                name, cell, x, y, orientation = found.groups()
                components[name] = Component(_plain(name), cell, (int(x) * um, int(y) * um), orientation)
        length, vias = 0.0, 0
        for statement in _statements(text, "NETS"):
            head = statement.split(" + ")[0]
            net = _plain(head.split()[1])
            for name, pin in re.findall(r"\( (\S+) (\S+) \)", head):
                if name != "PIN":
                    components[name].pins[pin] = net
            for _, points in SEGMENT.findall(statement):
                segment, number = _segment(points)
                length, vias = length + segment * um, vias + number
        straps = []
        for statement in _statements(text, "SPECIALNETS"):
            net = statement.split()[1]
            for layer, _, x, _, to, _ in STRAP.findall(statement):
                if layer == strap and to in ("*", x):
                    straps.append((net, round(int(x) * um, 4)))
        size = round(right - left, 4), round(top - bottom, 4)
        return cls(size, core, tuple(components.values()), tuple(straps), round(length, 1), vias)

    def netlist(self, name: str, ports: tuple[Port, ...]) -> Netlist:
        """Return the netlist of the module ``name``, without diodes; cells that fill rows have no pins."""
        kept = (c for c in self.components if c.cell != DIODE)
        return Netlist(name, ports, tuple(Instance(c.name, c.cell, dict(sorted(c.pins.items()))) for c in kept))

    def diodes(self) -> list[str]:
        """Nets of the diodes."""
        return [c.pins["i"] for c in self.components if c.cell == DIODE]

    def instances(self, widths: Mapping[str, float], row_um: float) -> list[list[object]]:
        """[None, cell, x, y, orientation] of each instance of `netlist`, in its order: um of the cell's origin."""
        rows = []
        for c in self.components:
            if c.cell != DIODE:
                number, right, top = ORIENTATIONS[c.orientation]
                x, y = c.at_um[0] + right * widths[c.cell], c.at_um[1] + top * row_um
                rows.append([None, c.cell, round(x, 4), round(y, 4), number])
        return rows


def _statements(text: str, section: str) -> Iterator[str]:
    """Each statement of a section, on one line."""
    found = re.search(rf"(?ms)^{section} \d+ ;\n(.*?)^END {section}$", text)
    for statement in found[1].split(" ;\n") if found else ():
        line = " ".join(statement.split())
        if line.startswith("- "):
            yield line


def _segment(points: str) -> tuple[int, int]:
    """Length (DEF's unit) and vias of a segment's points; a box is a patch of metal."""
    length, at = 0, None
    bare = re.sub(r"RECT \([^)]*\)", "", points)
    for x, y in re.findall(r"\( (\S+) (\S+)(?: \S+)? \)", bare):
        to = [at[k] if at and word == "*" else int(word) for k, word in enumerate((x, y))]
        length += sum(abs(new - old) for new, old in zip(to, at or to, strict=True))
        at = to
    vias = len(re.sub(r"\([^)]*\)|\bVIRTUAL\b|\bMASK \d+", "", bare).split())
    return length, vias


def _plain(name: str) -> str:
    """A name without DEF's escapes."""
    return name.replace("\\", "")
