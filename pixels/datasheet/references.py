"""All lanes on one set of references, behind the board: different codes at the same time, at one corner.

Conversions follow each other without a pause; in each, every group searches a value of PATTERNS. A level is
off by what the comparator's inputs just before a strobe differ from a straight line through all of its lane.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from talbot.cells.corner import Corner
from talbot.models.digital.sar import BITS
from talbot.pixels.circuits.board import REFERENCES, Board
from talbot.pixels.circuits.lane import PINS, LaneSizes, sar_lane
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet.deck import Setup, bits, clock, deck, patient, settled, simulator
from talbot.pixels.datasheet.lane import codes_of

GROUPS = 1, 3, 4  # lanes that do the same, the farthest from the pin first
# LSB above code 0, of each group: all alike; one lane against all others, whose every bit is the opposite; ends; apart
PATTERNS = (127.9, 127.9, 127.9), (170.4, 85.4, 85.4), (8.9, 254.0, 254.0), (129.4, 37.4, 201.1)
CYCLES = BITS + 1  # of a conversion: a sample, then decisions
BEFORE = 0.1e-9  # s before a strobe at which levels are taken
NEAR = 32.0  # LSB from a level within which what is off at it counts


@dataclass(frozen=True)
class ReferencesResult:
    """At one corner.

    off: LSB, of levels near a value, at most; anywhere: of all levels. settling: s from a cycle's begin until a lane's
    input is within half an LSB of what it is at the strobe, the slowest. ripple: V from end to end of refp less refn at
    the farthest lane.
    """

    off: float
    anywhere: float
    settling: float
    ripple: float
    runs: int
    repeated: int


def measure(
    setup: Setup,
    sizes: LaneSizes,
    corner: Corner,
    strobe: float,
    board: Board | None = None,
    circuit: Circuit | None = None,
    patterns: Sequence[Sequence[float]] = PATTERNS,
) -> ReferencesResult:
    """Measure all lanes. strobe: s from a cycle's begin. circuit: of a lane, instead of that of ``sizes``."""
    spec, period, lane = setup.spec, 1 / setup.spec.f_clk, circuit or sar_lane(sizes)
    count, vdd = CYCLES * len(patterns), corner.supply
    nets = {"lane_a": "a", "comparator": "q", **{f"d{k}": f"d{k}_" for k in range(BITS)}, **{n: n for n in REFERENCES}}
    copies = [[f"{nets[pin]}{k}" if pin in nets else pin for pin in PINS] for k in range(len(GROUPS))]
    stimulus = {
        "lane_b": [(0.0, (spec.refp + spec.refn) / 2)],
        "sample": bits(([True] + [False] * BITS) * len(patterns), period, vdd),
        "strobe": clock(count, period, vdd, strobe / period),
    }
    codes = np.zeros((len(GROUPS), count), int)
    values = np.repeat(np.array(patterns).T, CYCLES, 1)
    for k in range(len(GROUPS)):
        searches = [codes_of(pattern[k]) for pattern in patterns]
        codes[k] = [code for search in searches for code in (search[0], *search)]
        volts = spec.refn + values[k] * spec.lsb
        points = [(0.0, volts[0])]
        for n in np.flatnonzero(np.diff(volts)) + 1:
            points += [(n * period, volts[n - 1]), (n * period + 1e-9, volts[n])]
        stimulus[f"a{k}"] = points
        stimulus |= {f"d{b}_{k}": bits([code >> b & 1 for code in codes[k]], period, vdd) for b in range(BITS)}
    lines = [*deck(lane, setup, corner, copies), *(board or Board()).lines(GROUPS)]
    rails = {f"{name}_ext": getattr(spec, name) for name in REFERENCES}
    plates = [f"xc{k}.{net}" for k in range(len(GROUPS)) for net in ("top", "other")]
    seen = (*(f"q{k}" for k in range(len(GROUPS))), *plates, "refp0", "refn0")
    with simulator(lines, tuple(stimulus), seen, corner, rails, patient(900)) as spice:
        wave = spice.transient(stimulus, {f"q{k}": 5e-15 for k in range(len(GROUPS))}, count * period, period / 50)
        runs, repeated = spice.runs, spice.repeated
    decided = np.flatnonzero(np.arange(count) % CYCLES)
    off, slow = np.zeros((len(GROUPS), len(decided))), 0.0
    away = values[:, decided] - codes[:, decided] + 0.5
    for k in range(len(GROUPS)):
        apart = wave.voltage[f"xc{k}.other"] - wave.voltage[f"xc{k}.top"]
        ends = decided * period + strobe - BEFORE
        slope, zero = np.polyfit(away[k], at := np.interp(ends, wave.time, apart), 1)
        off[k] = (at - zero) / slope - away[k]
        for n, end, volts in zip(decided, ends, at, strict=True):
            slow = max(slow, settled(wave.time, apart - volts, n * period, end, 0.5 * slope))
    across = wave.voltage["refp0"] - wave.voltage["refn0"]
    near = np.abs(off[np.abs(away) < NEAR]).max()
    return ReferencesResult(float(near), float(np.abs(off).max()), slow, float(np.ptp(across)), runs, repeated)
