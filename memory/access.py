"""A column in ngspice: 0 and 1 written and read; access, writing, precharge, the bit lines' difference."""

from dataclasses import dataclass

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Simulator
from talbot.cells.spice.settings import Settings
from talbot.cells.spice.wave import Wave
from talbot.memory.column import column
from talbot.memory.parameters import SramParameters
from talbot.platforms.sky130 import analog as sky130

EDGE = 100e-12  # s, of inputs
LOAD = 20e-15  # F, at the output
SEQUENCE = (("write", 0), ("read", 0), ("write", 1), ("read", 1))
PROBES = "q", "wl", "bl", "br", "sense", "cell"
SETTLED = 0.02  # V between the bit lines after precharge


@dataclass(frozen=True)
class Access:
    """Of a column, the worst of both bits, s.

    right: whether each bit written was read. access: from clk to q. write: from clk to the cell's node. precharge: from
    clk's end. difference: V between the bit lines as the sense amplifier starts.
    """

    right: bool
    access: float
    write: float
    precharge: float
    difference: float

    @property
    def cycle(self) -> float:
        """The shortest cycle, s: an access or a write, then precharge."""
        return max(self.access, self.write) + self.precharge


def measure(sram: SramParameters, netlist: str, corner: str, half: float = 3e-9) -> Access:
    """Return what a column does at a corner with a clock of 2 x ``half`` s. Raises SimulationError."""
    at, circuit = Corner.parse(corner), column(sram, netlist)
    circuit.check(sky130)
    lines = [*sky130.cards(at.process, circuit.sizes()), ".param cscale=1 rscale=1", *circuit.lines(sky130)]
    lines.append(f"Xcell {' '.join(circuit.ports)} column")
    rails, high = {"vdd": at.supply, "vss": 0.0}, at.supply
    starts = [(2 * k + 1) * half for k in range(len(SEQUENCE))]
    clk, we, d = [(0.0, 0.0)], [(0.0, 0.0)], [(0.0, 0.0)]
    for start, (kind, bit) in zip(starts, SEQUENCE, strict=True):
        clk += [(start, 0.0), (start + EDGE, high), (start + half, high), (start + half + EDGE, 0.0)]
        for points, level in ((we, kind == "write"), (d, kind == "write" and bit)):
            points += [(start - half / 2, points[-1][1]), (start - half / 2 + EDGE, high * level)]
    with Simulator(lines, ("clk", "we", "d"), PROBES, rails, at.temperature, Settings(timeout=600)) as spice:
        loads = dict.fromkeys(PROBES, 1e-18) | {"q": LOAD}
        wave = spice.transient({"clk": clk, "we": we, "d": d}, loads, starts[-1] + 2 * half, 20e-12)
    return judged(wave, starts, half, high)


def judged(wave: Wave, starts: list[float], half: float, high: float) -> Access:
    """Return the figures of a run. starts: of clk's pulses of ``half`` s. high: the supply, V."""
    right, accesses, writes, differences, precharges = True, list[float](), list[float](), list[float](), list[float]()
    for start, (kind, bit) in zip(starts, SEQUENCE, strict=True):
        begin, end = start + EDGE / 2, start + half
        node = "cell" if kind == "write" else "q"
        right &= (wave.at(node, end) > high / 2) == bool(bit)
        changed = crossed(wave, node, high / 2, begin, end)
        (writes if kind == "write" else accesses).append(changed - begin)
        if kind == "read":
            fires = crossed(wave, "sense", high / 2, begin, end)
            differences.append(abs(wave.at("bl", fires) - wave.at("br", fires)))
        inside = (wave.time > end) & (wave.time < end + half)
        low = np.minimum(wave.voltage["bl"], wave.voltage["br"])[inside]
        precharges.append(float(wave.time[inside][low < high - SETTLED].max(initial=end)) - end)
    return Access(right, max(accesses), max(writes), max(precharges), min(differences))


def crossed(wave: Wave, node: str, level: float, begin: float, end: float) -> float:
    """Return the last time from ``begin`` to ``end`` at which ``node`` crosses ``level``, else ``begin``."""
    inside = np.flatnonzero((wave.time > begin) & (wave.time < end))
    above = wave.voltage[node][inside] > level
    changes = np.flatnonzero(above[1:] != above[:-1])
    return float(wave.time[inside[changes[-1] + 1]]) if len(changes) else begin
