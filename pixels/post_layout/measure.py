"""The drawn circuits with their parasitics measured as the schematics are, by pixels/datasheet, side by side."""

from dataclasses import dataclass

from talbot.cells.corner import Corner
from talbot.pixels.circuits.comparator import comparator
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet.comparator import EDGE, LOAD, Decisions, decisions
from talbot.pixels.datasheet.deck import Setup, deck, simulator
from talbot.pixels.datasheet.lane import LaneResult
from talbot.pixels.datasheet.lane import measure as measure_lane

REACH, STEPS = 8.0, 11  # LSB at the lane's input, bisections: to 0.008 LSB
PERIOD = 20e-9  # s, of the decisions whose outcome alone counts


@dataclass(frozen=True)
class Measured:
    """A circuit's figures at one corner. offset: LSB, systematic: of the comparator without mismatch."""

    decisions: Decisions
    offset: float
    lane: LaneResult | None = None


def offset(setup: Setup, sizes: LaneSizes, corner: Corner, circuit: Circuit | None = None) -> float:
    """The systematic offset of a comparator, LSB at the lane's input: V(inp) - V(inn) at which its decision changes.

    From the precharged state. One beyond REACH is +-REACH.
    """
    spec, vdd, lsb = setup.spec, corner.supply, setup.spec.lsb * sizes.attenuation
    lines = deck(circuit or comparator(sizes.comparator), setup, corner)
    low, high = -REACH, REACH
    strobe = [(0.0, 0.0), (PERIOD / 2, 0.0), (PERIOD / 2 + EDGE, vdd), (PERIOD, vdd)]
    with simulator(lines, ("inp", "inn", "strobe"), ("q",), corner) as spice:
        for _ in range(STEPS):
            middle = (low + high) / 2
            stimulus = {
                "strobe": strobe,
                "inp": [(0.0, spec.vcm + middle * lsb / 2)],
                "inn": [(0.0, spec.vcm - middle * lsb / 2)],
            }
            wave = spice.transient(stimulus, {"q": LOAD}, PERIOD, PERIOD / 40)
            low, high = (low, middle) if wave.at("q", PERIOD) > vdd / 2 else (middle, high)
    return (low + high) / 2


def measure(
    setup: Setup,
    sizes: LaneSizes,
    corner: Corner,
    comparator_circuit: Circuit | None = None,
    lane_circuit: Circuit | None = None,
    lane: bool = True,
) -> Measured:
    """Comparator and, with ``lane``, lane at a corner; without circuits the schematics of ``sizes``."""
    return Measured(
        decisions(setup, sizes, corner, comparator_circuit),
        offset(setup, sizes, corner, comparator_circuit),
        measure_lane(setup, sizes, corner, lane_circuit) if lane else None,
    )
