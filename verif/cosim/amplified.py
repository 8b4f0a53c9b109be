"""The difference amplifier of a lane in the deck of a co-simulation, with its bias, and what its columns carry.

    clk        |‾‾‾‾|____|‾‾‾‾|____|
    hold       |________|‾‾‾‾‾‾‾‾|
    reset      |‾‾‾‾‾‾‾‾|________|‾     not hold; ends the lane's sample before it begins again
    columns    | level  | signal |      2 ns after the reset's end
    sample     |__________|__‾‾‾‾|      of the lane, after its last decision

It is never off.
"""

from typing import Protocol

from talbot.pixels.circuits.amplifier import TRIM_BITS, UNITS, AmplifierSizes, AmplifierSpec, amplifier
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.circuits.specification import LaneSpec
from talbot.pixels.circuits.support import bias
from talbot.pixels.datasheet.amplifier import COLUMNS
from talbot.pixels.datasheet.deck import Setup
from talbot.pixels.datasheet.job import amplifier_of

AFTER = 1e-9  # s after the sample's end at which columns leave the lanes and the reset begins


def sized(pdk: str, spec: LaneSpec, lane: LaneSizes) -> tuple[AmplifierSpec, AmplifierSizes]:
    """Return the amplifier of a lane of ``spec``."""
    return amplifier_of(Setup(pdk, spec), lane)


def circuits(sizes: AmplifierSizes) -> tuple[Circuit, ...]:
    """Parts of a lane other than its converter."""
    return amplifier(sizes), bias()


class Drive(Protocol):
    """Adds a control and returns its node: `deck._source` of a deck."""

    def __call__(
        self, name: str, high: float, bit: int, /, *, rise: float = ..., fall: float = ..., low: float = ...
    ) -> str: ...


def column_volts(spec: LaneSpec, sizes: AmplifierSizes, gain: float) -> float:
    """Return volts of a column for an LSB of a diode, so that a difference of 1 LSB is ``gain`` LSB at the lane."""
    return gain * spec.lsb / sizes.gain


def lane_lines(lane: int, drive: Drive, supply: float, dark: bool = True, second: str = "") -> list[str]:
    """The amplifier of a lane from its columns cola, colb to its input. drive: makes its controls.

    dark: between samples its columns are at column_dark; else something else puts them there. second: in raw mode, the
    node that is high for the second diode.
    """
    reset = drive(f"amplifier_reset{lane}", 0.0, lane, fall=AFTER, low=supply)
    code = ("vdd" if UNITS >> k & 1 else "0" for k in reversed(range(TRIM_BITS)))
    mode = f"vdd 0 {second}" if second else "0 0 0"
    pins = f"cola{lane} colb{lane} vdd {reset}", " ".join(code), f"{mode} in{lane} ref ibias{lane} vdd 0 amplifier"
    lines = [f"Xamplifier{lane} {' '.join(pins)}", f"Xbias{lane} ibias{lane} vdd 0 bias"]
    if dark:
        on = drive(f"amplifier_dark{lane}", 0.0, lane, rise=COLUMNS / 2, fall=2 * AFTER, low=supply)
        lines += [f"Xdark{d}{lane} column_dark col{d}{lane} {on} vdd 0 selector" for d in "ab"]
    return lines
