"""A row's driver with its lines at one corner: levels, settling, slew, energy, leakage of an idle row."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points
from talbot.cells.spice.wave import Wave
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.circuits.row_driver import (
    CONTROLS,
    FAR,
    ROW_INPUTS,
    ROW_LINES,
    SUPPLIES,
    RowDriverSpec,
    row,
    row_line,
)
from talbot.pixels.datasheet.deck import EDGE, Setup, deck, patient, settled, simulator

AROUND = 0.9, 1.0, 1.1  # of the lines' level: limits hold in any combination with the chip's
# Cycles in which each control is high; the row is chosen until CHOSEN, and its controls come once more after it
HIGH = {
    "pixel_reset": ((1, 3), (23, 24)),
    "read": ((4, 6), (22, 23)),
    "expose": ((7, 8), (24, 25)),
    "integrate": ((10, 12), (25, 26)),
    "shutter": ((13, 15),),
    "tap0": ((16, 17),),
    "tap1": ((17, 18),),
}
CHOSEN, CYCLES = 20, 27
LINES = {f"{name}_row": spans[:1] for name, spans in HIGH.items() if name != "expose"} | {"integrate_row": ((7, 12),)}


@dataclass(frozen=True)
class RowDriverResult:
    """At one corner, the worst of AROUND.

    right: whether all lines were high where they must be, and there alone. settling, slew: s, the far end's, of the
    slowest edge. energy: J of a pulse of the select line, both supplies. idle: A of the lines' supply and the chip's.
    """

    right: bool
    settling: float
    slew: float
    energy: float
    idle: float
    runs: int
    repeated: int


def measure(
    setup: Setup, spec: RowDriverSpec, corner: Corner, driver: Circuit | None = None, around: Sequence[float] = AROUND
) -> RowDriverResult:
    """Return the row of ``spec`` at a corner. driver: instead of `row`. around: of its lines' level."""
    found, runs, repeated = [], 0, 0
    lines = deck(bench(spec, driver or row()), setup, corner)
    for factor in around:
        high = factor * spec.high
        with simulator(lines, ROW_INPUTS, ROW_LINES, corner, {"vddr": high}, patient(600)) as spice:
            wave = spice.transient(stimulus(spec, corner.supply), {}, CYCLES * spec.settle, spec.settle / 20)
            runs, repeated = runs + spice.runs, repeated + spice.repeated
        found.append(_figures(wave, spec, corner, high))
    return RowDriverResult(
        right=all(one["right"] for one in found),
        **{name: float(max(one[name] for one in found)) for name in ("settling", "slew", "energy", "idle")},
        runs=runs,
        repeated=repeated,
    )


def bench(spec: RowDriverSpec, driver: Circuit) -> Circuit:
    """Return the driver with a line behind each of its outputs; the lines' names are those of their far ends."""
    near = tuple(f"{line}_near" for line in ROW_LINES)
    ends = [Instance(line, row_line(spec), (start, line, "vss")) for line, start in zip(ROW_LINES, near, strict=True)]
    parts = (Instance("driver", driver, (*ROW_INPUTS, *near, *SUPPLIES)), *ends)
    return Circuit("bench", (*ROW_INPUTS, *ROW_LINES, *SUPPLIES), instances=parts)


def stimulus(spec: RowDriverSpec, high: float) -> dict[str, Points]:
    """Waveforms of ROW_INPUTS."""
    cycle = spec.settle
    found: dict[str, Points] = {name: [(0.0, high)] for name in ROW_INPUTS if name not in CONTROLS}
    for side in ("amp_low", "reset_low"):  # another row of the same eight is chosen then
        found[side] = [(0.0, high), (CHOSEN * cycle, high), (CHOSEN * cycle + EDGE, 0.0)]
    for name, spans in HIGH.items():
        points = [(0.0, 0.0)]
        for up, down in spans:
            points += [(up * cycle, 0.0), (up * cycle + EDGE, high)]
            points += [(down * cycle, high), (down * cycle + EDGE, 0.0)]
        found[name] = points
    return found


def _figures(wave: Wave, spec: RowDriverSpec, corner: Corner, high: float) -> Mapping[str, float]:
    cycle, right, settling, slew = spec.settle, True, [], []
    for line, ((up, down),) in LINES.items():
        for k in range(up, CYCLES):  # until its first reset a row may be open
            wanted = high if up <= k < down else 0.0
            right &= abs(wave.at(line, (k + 1) * cycle - EDGE) - wanted) < high / 4
        for edge, level in ((up * cycle, high), (down * cycle, 0.0)):
            settling.append(settled(wave.time, wave.voltage[line] - level, edge, edge + cycle, FAR * high))
            inside = (wave.time > edge) & (wave.time < edge + cycle)
            between = (wave.voltage[line][inside] > 0.1 * high) & (wave.voltage[line][inside] < 0.9 * high)
            times = wave.time[inside][between]
            slew.append(float(np.ptp(times)) if len(times) else cycle)
    begin, end = 4 * cycle - EDGE, 7 * cycle - EDGE
    energy = sum(wave.charge(name, begin, end) * volts for name, volts in (("vddr", high), ("vdd", corner.supply)))
    quiet = (CYCLES - 0.5) * cycle, CYCLES * cycle
    idle = sum(wave.charge(name, *quiet) for name in ("vdd", "vddr")) / (0.5 * cycle)
    return {"right": right, "settling": max(settling), "slew": max(slew), "energy": energy, "idle": idle}
