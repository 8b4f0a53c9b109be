"""The die in a package: a lead for every bond pad, as a table and a drawing."""

import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.steps import StepError
from talbot.base.style import own_style
from talbot.flow.layout.sensor.ring import OUTSIDE
from talbot.platforms.pads import PadProcess

LEADS = 48, 64, 80, 100, 128, 144  # of a QFN, as many on each side
PITCHES_MM = 0.5, 0.4  # of the leads, the preferred one first
CORNER_MM, LEAD_MM = 1.0, 0.6  # from the body's corner to the first lead; length of a lead
WIRE_MM = 5.0  # longest bond wire, seen from above
ORDER = "west", "south", "east", "north"  # counterclockwise from lead 1, the north one of the west
Point = tuple[float, float]
Wire = tuple[Point, Point]
BACKWARDS = "west", "north"  # sides whose leads have falling coordinates


@dataclass(frozen=True)
class Package:
    """A QFN. leads: as many on each side. pitch_mm: of the leads."""

    leads: int
    pitch_mm: float = PITCHES_MM[0]

    @property
    def each(self) -> int:
        """Leads on a side."""
        return self.leads // 4

    @property
    def body_mm(self) -> float:
        """Side of the package."""
        return round((self.each - 1) * self.pitch_mm + 2 * CORNER_MM, 3)

    @property
    def text(self) -> str:
        """Name and size."""
        return f"QFN-{self.leads}, {self.body_mm:g} mm x {self.body_mm:g} mm"

    def lead_mm(self, side: str, slot: int) -> Point:
        """Middle of the inner end of a side's lead ``slot``, from the body's middle."""
        along, out = (slot - (self.each - 1) / 2) * self.pitch_mm, self.body_mm / 2 - LEAD_MM
        return {"west": (-out, -along), "south": (along, -out), "east": (out, along), "north": (-along, out)}[side]


@dataclass(frozen=True)
class Lead:
    """Lead ``number`` and its bond pad.

    cell: of the pad. pad_um: middle of the pad on the die. lead_mm: the lead's end, from the body's middle. die_mm: its
    size.
    """

    number: int
    signal: str
    cell: str
    pad_um: tuple[float, float]
    lead_mm: tuple[float, float]
    die_mm: tuple[float, float]

    @property
    def wire(self) -> Wire:
        """Ends of the bond wire, mm from the body's middle."""
        x, y = (um / 1000 - size / 2 for um, size in zip(self.pad_um, self.die_mm, strict=True))
        return (x, y), self.lead_mm

    @property
    def wire_mm(self) -> float:
        """Length of the bond wire, seen from above."""
        (x, y), (to_x, to_y) = self.wire
        return ((x - to_x) ** 2 + (y - to_y) ** 2) ** 0.5


def packaged(plan: Mapping[str, Any]) -> tuple[Package, list[Lead]]:
    """Package with the fewest leads that serve the fullest side, and the leads of the pads in their order.

    The pitch is the first with no bond wire above WIRE_MM, or the last. Raises StepError for too many pads.
    """
    pads = {side: [place for place in plan["ring"] if place["side"] == side and place["nets"]] for side in ORDER}
    most = max(map(len, pads.values()))
    total = next((count for count in LEADS if count >= 4 * most), 0)
    if not total:
        raise StepError(f"package: {most} pads on a side, {LEADS[-1] // 4} leads at most")
    die = plan["die"][0] / 1e6, plan["die"][1] / 1e6
    choices = [(package, _leads(package, pads, die)) for package in (Package(total, pitch) for pitch in PITCHES_MM)]
    short = (choice for choice in choices if max((lead.wire_mm for lead in choice[1]), default=0) <= WIRE_MM)
    return next(short, choices[-1])


def _leads(package: Package, pads: Mapping[str, Sequence[Mapping[str, Any]]], die: tuple[float, float]) -> list[Lead]:
    leads = []
    for place, side in enumerate(ORDER):
        ordered = sorted(pads[side], key=lambda pad: pad["at"], reverse=side in BACKWARDS)
        for k, pad in enumerate(ordered):
            slot = (2 * k + 1) * package.each // (2 * len(ordered))
            left, bottom, right, top = pad["box"]
            at, number = ((left + right) / 2e3, (bottom + top) / 2e3), place * package.each + slot + 1
            leads.append(Lead(number, signal(pad["name"]), pad["cell"], at, package.lead_mm(side, slot), die))
    return leads


def signal(pad: str) -> str:
    """What the lead of a pad is called: 'pad_vdd_2' is one of vdd."""
    return re.sub(r"_\d+$", "", pad.removeprefix(OUTSIDE))


def crossings(leads: Sequence[Lead]) -> list[tuple[str, str]]:
    """Pairs of signals whose bond wires cross."""
    return [(a.signal, b.signal) for a, b in itertools.combinations(leads, 2) if _cross(a.wire, b.wire)]


def _cross(one: Wire, other: Wire) -> bool:
    """Whether two segments cross."""

    def turn(wire: Wire, at: Point) -> float:
        """Twice the area of a triangle, positive when it is counterclockwise."""
        (x, y), (to_x, to_y) = wire
        return (to_x - x) * (at[1] - y) - (to_y - y) * (at[0] - x)

    return all(turn(a, b[0]) * turn(a, b[1]) < 0 for a, b in ((one, other), (other, one)))


def volts(lead: Lead, process: PadProcess, analog_v: float, reset_v: float) -> float | None:
    """Level of a lead; None of an analog signal, whose pad has no level of its own."""
    if lead.cell == process.signals["analog"]:
        return None
    known = {"vdd": process.core_v, "vddc": process.core_v, "vdda": analog_v, "vddr": reset_v} | dict.fromkeys(
        ("vss", "vssa", "vssio"), 0.0
    )
    return known.get(lead.signal, process.pad_v)


def table(package: Package, leads: Sequence[Lead], volt: Mapping[str, float | None], clamps: Mapping[str, str]) -> str:
    """The pin map as Markdown. clamps: of a cell what protects it."""
    lines = [
        f"# Pin map: {package.text}, leads every {package.pitch_mm:g} mm",
        "",
        f"{len(leads)} of {package.leads} leads; the others are not connected. Lead 1 is the north one of the west "
        "side, numbers are counterclockwise, seen from above. The longest bond wire is "
        f"{max(lead.wire_mm for lead in leads):.2f} mm.",
        "",
        "| lead | signal | V | pad | x, y on the die, um |",
        "|---:|---|---:|---|---|",
    ]
    for lead in leads:
        level = volt[lead.signal]
        x, y = lead.pad_um
        lines.append(
            f"| {lead.number} | {lead.signal} | {'' if level is None else f'{level:g}'} | {lead.cell} | {x:g}, {y:g} |"
        )
    lines += [
        "",
        "| pad | clamps and protection |",
        "|---|---|",
        *(f"| {cell} | {text} |" for cell, text in clamps.items()),
    ]
    return "\n".join(lines) + "\n"


def protection(spice: str, cells: Sequence[str]) -> dict[str, str]:
    """Of each pad what its netlist has of clamps: widths of transistors by oxide, resistor and diodes behind them.

    Raises StepError for a pad that has no clamp.
    """
    bodies = {m[1]: m[2] for m in re.finditer(r"(?ms)^\.subckt (\S+)[^\n]*\n(.*?)^\.ends", spice)}

    def inside(cell: str) -> Iterator[tuple[str, str]]:
        """Pairs (cell, line) of all devices."""
        for line in bodies[cell].splitlines():
            if line.startswith("X"):
                yield from inside(line.split()[-1])
            else:
                yield cell, line

    found = {}
    for cell in cells:
        width = dict[tuple[str, str], float]()
        parts = []
        for of, line in inside(cell):
            if line.startswith("Mclamp_") and (m := re.search(r"([np])fet_(\S+) l=\S+ w=(\S+)", line)):
                kind = m[1], "" if m[2].startswith("g5v0d10v5") else " of thin oxide"
                width[kind] = width.get(kind, 0.0) + 1e6 * float(m[3])
            if of == "SecondaryProtection" and line.startswith("R"):
                parts.append(f"{float(line.split()[3]):.0f} Ohm and two diodes behind it")
            if of.startswith("RCClampInverter") and "RC clamp" not in parts:
                parts.append("RC clamp")
        if not width:
            raise StepError(f"pads: {cell} has no clamp")
        clamps = [f"{kind} {um:.0f} um{oxide}" for (kind, oxide), um in sorted(width.items())]
        found[cell] = ", ".join([*clamps, *parts])
    return found


@own_style()
def draw(paths: Sequence[Path], package: Package, leads: Sequence[Lead]) -> None:
    """The package from above: leads, bond wires and the die, to scale."""
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Rectangle

    side, (width, height) = package.body_mm, leads[0].die_mm
    figure = Figure(figsize=(9, 9), layout="constrained")
    axes = figure.subplots()
    axes.add_patch(Rectangle((-side / 2, -side / 2), side, side, facecolor="#f4f4f4", edgecolor="0.3"))
    axes.add_patch(Circle((-side / 2 + 0.45, side / 2 - 0.45), 0.18, facecolor="0.3"))
    axes.add_patch(Rectangle((-width / 2, -height / 2), width, height, facecolor="#c9dcec", edgecolor="0.3"))
    named, pitch = {lead.number: lead for lead in leads}, package.pitch_mm
    for number in range(1, package.leads + 1):
        place, slot = divmod(number - 1, package.each)
        way = ORDER[place]
        x, y = package.lead_mm(way, slot)
        flat, lead = way in ("west", "east"), named.get(number)
        size = (LEAD_MM, pitch / 2) if flat else (pitch / 2, LEAD_MM)
        left = x - (LEAD_MM if way == "west" else 0 if flat else pitch / 4)
        bottom = y - (LEAD_MM if way == "south" else 0 if not flat else pitch / 4)
        axes.add_patch(Rectangle((left, bottom), *size, facecolor="#b8860b" if lead else "0.85", linewidth=0))
        out = side / 2 + 0.15
        at = {"west": (-out, y), "east": (out, y), "south": (x, -out), "north": (x, out)}[way]
        style = {"ha": {"west": "right", "east": "left"}.get(way, "center"), "rotation": 0 if flat else 90}
        style["va"] = {"south": "top", "north": "bottom"}.get(way, "center")
        axes.annotate(
            f"{number} {lead.signal}" if lead else str(number), at, fontsize=6, color="0.1" if lead else "0.6", **style
        )
    axes.add_collection(LineCollection([lead.wire for lead in leads], colors="#b8860b", linewidths=0.6))
    for lead in leads:
        (x, y), _ = lead.wire
        axes.add_patch(Rectangle((x - 0.04, y - 0.04), 0.08, 0.08, facecolor="#b8860b", linewidth=0))
    axes.annotate(f"die {width:g} × {height:g} mm", (0, 0), ha="center", va="center", fontsize=9)
    axes.annotate(f"{package.text.replace(' mm x', ' ×')}, from above", (0, side / 2 - 1.2), ha="center", fontsize=9)
    margin = side / 2 + 1.6
    axes.set(xlim=(-margin, margin), ylim=(-margin, margin), aspect="equal")
    axes.axis("off")
    for path in paths:
        figure.savefig(path, dpi=130, metadata={"Date": None} if path.suffix == ".svg" else {"Software": None})
