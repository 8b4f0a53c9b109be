"""A converter lane in transistors: sample and hold, DAC, comparator, and the drivers of their switches.

Pins of `sar_lane`: lane_a lane_b sample strobe d7 d6 d5 d4 d3 d2 d1 d0 comparator refp refn vcm vdd vss.

    clk        |‾‾‾‾|____|‾‾‾‾|____|‾‾‾‾|____|      f_clk, a decision a cycle
    hold       |‾‾‾‾‾‾‾‾‾|_________|_________       the chip's; `sample` is hold
    d7..d0     | ...     | d0      | d1             the chip's register
    strobe     |    |‾‾‾‾|    |‾‾‾‾|    |‾‾‾‾|      not clk
    comparator |               | 0       | 1        valid before the next edge of clk, kept until the next strobe

`comparator` is 1 where lane_a - lane_b >= (code - 128.5) LSB, LSB = (refp - refn) / 256: `models/afe`'s level(code) in
offset binary. Strobes while `sample` is 1 have no effect. The common plates' switches open first, so that the charge
they leave does not depend on the input.
"""

from dataclasses import dataclass
from types import ModuleType

from talbot.pixels.circuits import comparator as comparators
from talbot.pixels.circuits import dac as dacs
from talbot.pixels.circuits.gates import SWITCH_LENGTH, inverter, nor
from talbot.pixels.circuits.netlist import Circuit, Instance, Transistor
from talbot.pixels.circuits.specification import LaneSpec

PINS = ("lane_a", "lane_b", "sample", "strobe", *(f"d{k}" for k in reversed(range(dacs.BITS))))
PINS += ("comparator", "refp", "refn", "vcm", "vdd", "vss")


@dataclass(frozen=True)
class LaneSizes:
    """Sizes of a lane's parts. plate_w: um, of the n switches between the common plates and vcm."""

    comparator: comparators.ComparatorSizes
    dac: dacs.DacSizes
    plate_w: float = 12.0

    @property
    def attenuation(self) -> float:
        """Volts at the comparator for a volt at the lane's input."""
        return self.dac.attenuation(self.comparator.input_capacitance)


def size(spec: LaneSpec, process: ModuleType) -> LaneSizes:
    """Sizes for ``spec``: comparator and array depend on each other, so a few rounds."""
    comparator = comparators.size(spec, process, dacs.LEAST_ATTENUATION)
    array = dacs.size(spec, process, comparator.input_capacitance)
    for _ in range(4):
        comparator = comparators.size(spec, process, array.attenuation(comparator.input_capacitance))
        array = dacs.size(spec, process, comparator.input_capacitance)
    return LaneSizes(comparator, array)


def sar_lane(sizes: LaneSizes) -> Circuit:
    """Pins as PINS."""
    supplies, references = ("vdd", "vss"), ("refp", "refn", "vdd", "vss")
    bits = tuple(f"d{k}" for k in reversed(range(dacs.BITS)))
    drive = inverter(8)
    plate_n = ("vss", "n_lvt", sizes.plate_w, SWITCH_LENGTH)
    plate_p = ("vdd", "p_lvt", 2 * sizes.plate_w, 0.35)
    return Circuit(
        "sar_lane",
        PINS,
        (
            Transistor("plate_top_n", "top", "sample_1", "vcm", *plate_n),
            Transistor("plate_top_p", "top", "sample_2", "vcm", *plate_p),
            Transistor("plate_other_n", "other", "sample_1", "vcm", *plate_n),
            Transistor("plate_other_p", "other", "sample_2", "vcm", *plate_p),
        ),
        instances=(
            Instance("sample_0", inverter(2), ("sample", "sample_0", *supplies)),
            Instance("sample_1", inverter(4), ("sample_0", "sample_1", *supplies)),
            Instance("sample_2", inverter(4), ("sample_1", "sample_2", *supplies)),
            Instance("sample_3", inverter(4), ("sample_2", "sample_3", *supplies)),
            Instance("sample_n", drive, ("sample_3", "bottoms_n", *supplies)),
            Instance("sample_p", drive, ("bottoms_n", "bottoms", *supplies)),
            Instance("strobe_n", inverter(), ("strobe", "strobe_n", *supplies)),
            Instance("strobe_p", nor(4), ("strobe_n", "sample", "fire", *supplies)),
            Instance("dac", dacs.dac(sizes.dac), ("top", "lane_a", "bottoms", "bottoms_n", *bits, *references)),
            Instance("balance", dacs.balance(sizes.dac), ("other", "lane_b", "bottoms", "bottoms_n", *references)),
            Instance(
                "comparator",
                comparators.comparator(sizes.comparator),
                ("other", "top", "fire", "comparator", *supplies),
            ),
        ),
    )
