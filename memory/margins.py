"""Margins of a cell in ngspice: static noise margins by butterfly curves, write margin, read current.

For the curves the gates of both inverters are cut from their nodes and have one rising voltage: one sweep gives those
of both halves, while the bit lines are at the supply (read) or the word line is at 0 (hold). To write, the bit line of
a whole cell that stores 1 falls in a slow transient: where one of many cells changes, a sweep of operating points may
change others with it.

Static noise margin: the side of the largest square between the curves, of the smaller of both lobes [Seevinck1987].
Write margin: voltage of the bit line at which the cell changes. Read current: into the side that stores 0.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.cells.corner import Corner
from talbot.cells.netlist import spice
from talbot.pixels.pixel_circuit.deck import analyse
from talbot.platforms.sky130 import models as sky130

STEP = 0.045  # V, of the curves
FALL = 1.0, 0.0  # V: ends of the bit line's ramp
RAMP, STEPS = 1e-6, 100  # s of it, least number of steps
KINDS = "read", "write"
Curve = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Margins:
    """Of a cell without mismatch. hold, read, write: V. current: A."""

    hold: float
    read: float
    write: float
    current: float


def deck(netlist: str, corner: Corner, copies: int, seed: int | None, word: float, cut: bool) -> list[str]:
    """Return models, copies of the extracted cell, sources but that of bl.

    seed: mismatch is drawn with it, in every deck the same. word: V of the word line. cut: whether gates are cut from
    their nodes.
    """
    cell = spice.parse(netlist)
    sizes = {(t.model, t.size["w"], t.size["l"]) for t in cell.transistors}
    lines = sky130.cards("binned", corner.process, sizes)
    if seed is not None:
        lines = [f".option seed={seed}", *(one.replace("mc_mm_switch=0", "mc_mm_switch=1") for one in lines)]
    high = corner.supply
    sources = {"vdd": high, "vss": 0.0, "wl": word, "br": high, "in": 0.0}
    lines += [f"V{net} {net} 0 {volts:g}" for net, volts in sources.items()]
    for k in range(copies):
        node = {net: f"{net}{k}" for net in ("q", "qn", "bl")}
        for t in cell.transistors:
            gate = "in" if cut and t.gate in node else node.get(t.gate, t.gate)
            drain, source = (node.get(net, net) for net in (t.drain, t.source))
            size = " ".join(f"{key}={value:.6g}" for key, value in sky130.drawn(t.size).items())
            lines.append(f"X{t.name}_{k} {drain} {gate} {source} {t.bulk} {t.model} {size}")
        lines.append(f"Vmeter{k} bl bl{k} 0")
        if not cut:
            lines.append(f".nodeset v(q{k})={high:g} v(qn{k})=0")
    return [*lines, f".temp {corner.temperature:g}", ".option gmin=1e-15 abstol=1e-14 itl1=300 itl2=200"]


def nominal(netlist: str, corner: str) -> Margins:
    """Return the margins of an extracted cell without mismatch at a corner, like sf_025C_1v80. Raises ToolError."""
    at = Corner.parse(corner)
    hold, read = (_curves(netlist, at, 1, None, word) for word in (0.0, at.supply))
    (write,) = spread(netlist, "write", corner, 1)
    return Margins(float(noise_margins(hold)[0]), float(noise_margins(read)[0]), write, float(read[0, -1, 3]))


def spread(netlist: str, kind: str, corner: str, copies: int, seed: int | None = None) -> list[float]:
    """Return the margin, V, of copies of an extracted cell; kind: of KINDS; seed: with mismatch. Raises ToolError."""
    at = Corner.parse(corner)
    if kind == "read":
        return noise_margins(_curves(netlist, at, copies, seed, at.supply)).tolist()
    lines = deck(netlist, at, copies, seed, at.supply, cut=False)
    lines.append(f"Vfall bl 0 PWL(0 {FALL[0]:g} {RAMP:g} {FALL[1]:g})")
    curves = _swept(lines, f"tran {RAMP / STEPS:g} {RAMP:g} 0 {RAMP / STEPS:g}", "bl", copies)
    return write_margins(curves).tolist()


def _curves(netlist: str, corner: Corner, copies: int, seed: int | None, word: float) -> Curve:
    """Return the curves of a cell whose gates are cut, its word line at ``word``, V."""
    lines = deck(netlist, corner, copies, seed, word, cut=True)
    lines.append(f"Vbl bl 0 {corner.supply:g}")
    return _swept(lines, f"dc vin 0 {corner.supply:g} {STEP:g}", "in", copies)


def _swept(lines: Iterable[str], analysis: str, source: str, copies: int) -> Curve:
    """Return [cell, point, (V of the net ``source``, q, qn, current of bl)]. Raises ToolError."""
    cells = [wave for k in range(copies) for wave in (f"v(q{k})", f"v(qn{k})", f"i(vmeter{k})")]
    x, *waves = analyse(lines, [analysis], [f"v({source})", *cells])
    return np.moveaxis(np.array([(x, *waves[3 * k : 3 * k + 3]) for k in range(copies)]), 1, 2)


def noise_margins(curves: Curve) -> Curve:
    """Return the static noise margins, V. curves: [cell, point, (input, q, qn, ...)], V; the input rises."""
    return np.array([min(lobe(x, a, b), lobe(x, b, a)) for x, a, b in np.moveaxis(curves[..., :3], -1, 1)])


def lobe(x: Curve, upper: Curve, other: Curve) -> float:
    """Side of the largest square between the curve (x, upper) and, in the upper left, the mirrored one (other, x).

    Along lines at 45 degrees: the square's diagonal is the distance of both curves on one of them. ``upper`` and
    ``other`` fall with x.
    """
    first, second = upper - x, x - other  # offsets of these lines
    offsets = np.linspace(max(first.min(), second.min()), min(first.max(), second.max()), 400)
    on_first = np.interp(offsets, first[::-1], x[::-1])
    on_second = np.interp(offsets, second, other)
    return float(np.max(on_first - on_second))


def write_margins(curves: Curve) -> Curve:
    """Return the bit line's voltage at which q falls below qn, V; 0 where it does not. curves: [cell, point, ...]."""
    flipped = curves[..., 1] < curves[..., 2]
    first = np.argmax(flipped, axis=1)
    return np.where(flipped.any(axis=1), curves[np.arange(len(curves)), first, 0], 0.0)
