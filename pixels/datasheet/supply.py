"""Ripple of the supply at a lane through its amplifier while it holds a difference, over frequency.

What is slower than a sample the reset takes away: the amplifier alone is the upper bound.
"""

from dataclasses import dataclass

from talbot.cells.corner import Corner
from talbot.pixels.circuits.amplifier import AmplifierSizes, AmplifierSpec
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.datasheet.deck import Setup
from talbot.pixels.datasheet.spread import still, with_lane
from talbot.pixels.pixel_circuit.deck import analyse

BAND = "dec 4 1e4 1e9"  # Hz
RIPPLE = 10e-3  # V, assumed: amplitude on the supply of the circuits


@dataclass(frozen=True)
class Ripple:
    """Hz, and V at the lane for a V of the supply."""

    hertz: list[float]
    gain: list[float]


def ripple(setup: Setup, spec: AmplifierSpec, sizes: AmplifierSizes, lane: LaneSizes, corner: Corner) -> Ripple:
    """Measure an amplifier with its bias, both on the supply, and a lane's array. Raises ToolError."""
    lines = [*still(setup, spec, sizes, corner, 0.0, "vdd"), *with_lane(setup, lane, corner)]
    hertz, gain = analyse(lines, [f"ac {BAND}"], ["real(frequency)", "vm(lane)"])
    return Ripple([float(f"{f:.4g}") for f in hertz], [float(f"{g:.4g}") for g in gain])
