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
PITCH_MM, CORNER_MM, LEAD_MM = 0.5, 1.0, 0.6  # of the leads; from the body's corner to the first; length of a lead
ORDER = "west", "south", "east", "north"  # counterclockwise from lead 1, the north one of the west
Point = tuple[float, float]
Wire = tuple[Point, Point]
BACKWARDS = "west", "north"  # sides whose leads have falling coordinates


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


def leads(plan: Mapping[str, Any]) -> tuple[int, list[Lead]]:
    """Number of the package's leads, the fewest for the fullest side, and the leads of the pads in their order."""
    pads = {side: [place for place in plan["ring"] if place["side"] == side and place["nets"]] for side in ORDER}
    most = max(map(len, pads.values()))
    total = next((count for count in LEADS if count >= 4 * most), 0)
    if not total:
        raise StepError(f"package: {most} pads on a side, {LEADS[-1] // 4} leads at most")
    each, die = total // 4, (plan["die"][0] / 1e6, plan["die"][1] / 1e6)
    found = []
    for place, side in enumerate(ORDER):
        here = sorted(pads[side], key=lambda pad: pad["at"], reverse=side in BACKWARDS)
        for k, pad in enumerate(here):
            slot = (2 * k + 1) * each // (2 * len(here))
            left, bottom, right, top = pad["box"]
            at = (left + right) / 2e3, (bottom + top) / 2e3
            name = signal(pad["name"])
            found.append(Lead(place * each + slot + 1, name, pad["cell"], at, _lead(side, slot, each), die))
    return total, found


def signal(pad: str) -> str:
    """What the lead of a pad is called: 'pad_vdd_2' is one of vdd."""
    return re.sub(r"_\d+$", "", pad.removeprefix(OUTSIDE))


def body_mm(total: int) -> float:
    """Side of the package."""
    return (total // 4 - 1) * PITCH_MM + 2 * CORNER_MM


def _lead(side: str, slot: int, each: int) -> Point:
    """Middle of a lead's inner end."""
    along, out = (slot - (each - 1) / 2) * PITCH_MM, body_mm(4 * each) / 2 - LEAD_MM
    return {"west": (-out, -along), "south": (along, -out), "east": (out, along), "north": (-along, out)}[side]


def crossings(found: Sequence[Lead]) -> list[tuple[str, str]]:
    """Pairs of signals whose bond wires cross."""
    return [
        (one.signal, other.signal) for one, other in itertools.combinations(found, 2) if _cross(one.wire, other.wire)
    ]


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


def table(total: int, found: Sequence[Lead], volt: Mapping[str, float | None], clamps: Mapping[str, str]) -> str:
    """The pin map as Markdown. clamps: of a cell what protects it."""
    lines = [
        f"# Pin map: QFN-{total}, {body_mm(total):g} mm x {body_mm(total):g} mm, {PITCH_MM:g} mm",
        "",
        f"{len(found)} of {total} leads; the others are not connected. Lead 1 is the north one of the west side, "
        "numbers are counterclockwise, seen from above. The longest bond wire is "
        f"{max(lead.wire_mm for lead in found):.2f} mm.",
        "",
        "| lead | signal | V | pad | x, y on the die, um |",
        "|---:|---|---:|---|---|",
    ]
    for lead in found:
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
def draw(paths: Sequence[Path], total: int, found: Sequence[Lead]) -> None:
    """The package from above: leads, bond wires and the die, to scale."""
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Rectangle

    side, (width, height) = body_mm(total), found[0].die_mm
    figure = Figure(figsize=(9, 9), layout="constrained")
    axes = figure.subplots()
    axes.add_patch(Rectangle((-side / 2, -side / 2), side, side, facecolor="#f4f4f4", edgecolor="0.3"))
    axes.add_patch(Circle((-side / 2 + 0.45, side / 2 - 0.45), 0.18, facecolor="0.3"))
    axes.add_patch(Rectangle((-width / 2, -height / 2), width, height, facecolor="#c9dcec", edgecolor="0.3"))
    named, each = {lead.number: lead for lead in found}, total // 4
    for number in range(1, total + 1):
        place, slot = divmod(number - 1, each)
        way = ORDER[place]
        x, y = _lead(way, slot, each)
        flat, lead = way in ("west", "east"), named.get(number)
        size = (LEAD_MM, PITCH_MM / 2) if flat else (PITCH_MM / 2, LEAD_MM)
        left = x - (LEAD_MM if way == "west" else 0 if flat else PITCH_MM / 4)
        bottom = y - (LEAD_MM if way == "south" else 0 if not flat else PITCH_MM / 4)
        axes.add_patch(Rectangle((left, bottom), *size, facecolor="#b8860b" if lead else "0.85", linewidth=0))
        out = side / 2 + 0.15
        at = {"west": (-out, y), "east": (out, y), "south": (x, -out), "north": (x, out)}[way]
        style = {"ha": {"west": "right", "east": "left"}.get(way, "center"), "rotation": 0 if flat else 90}
        style["va"] = {"south": "top", "north": "bottom"}.get(way, "center")
        axes.annotate(
            f"{number} {lead.signal}" if lead else str(number), at, fontsize=6, color="0.1" if lead else "0.6", **style
        )
    axes.add_collection(LineCollection([lead.wire for lead in found], colors="#b8860b", linewidths=0.6))
    for lead in found:
        (x, y), _ = lead.wire
        axes.add_patch(Rectangle((x - 0.04, y - 0.04), 0.08, 0.08, facecolor="#b8860b", linewidth=0))
    axes.annotate(f"die {width:g} × {height:g} mm", (0, 0), ha="center", va="center", fontsize=9)
    axes.annotate(f"QFN-{total}, {side:g} × {side:g} mm, from above", (0, side / 2 - 1.2), ha="center", fontsize=9)
    margin = side / 2 + 1.6
    axes.set(xlim=(-margin, margin), ylim=(-margin, margin), aspect="equal")
    axes.axis("off")
    for path in paths:
        figure.savefig(path, dpi=130, metadata={"Date": None} if path.suffix == ".svg" else {"Software": None})
