"""The interface of the chip and a lane with its amplifier: the chip's pins become phases of both.

    clk        |‾‾‾‾|____|‾‾‾‾|____|‾‾‾‾|____|      high and low for STROBE at the least
    hold       |_________|‾‾‾‾‾‾‾‾‾|_________
    convert    |_________|‾‾‾‾‾‾‾‾‾|‾‾‾‾‾‾‾‾‾      while lanes sample or decide
    reset      |‾‾‾‾‾‾‾‾‾|_________|‾‾‾‾‾‾‾‾‾      of the amplifier: ends before `track` begins, begins after its end
    strobe     |_________|_|‾‾‾‾‾‾‾|_|‾‾‾‾‾‾‾      STROBE after the rise of clk, until the next
    sample     |___________|__‾‾‾‾‾|_________      where the lane is enabled, once its last decision is over

A lane times its strobe: the DAC settles while a rise of clk passes a line of slow inverters, whose delay follows the
corner as the DAC's switches do. Of clk only the rise matters. The chip lets a lane sample in the cycle of its last
decision: the sample follows the strobe after inverters as slow as several decisions. Without `convert` no comparator is
strobed, and the line is at rest; `rest` is slow, so that it ends after the line has begun.
"""

from talbot.pixels.circuits.gates import inverter, nand, nor
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.circuits.support import non_overlap

CHIP = "hold", "en", "clk", "convert"
LATE, LATE_UM = 4, 1.1  # inverters by which the sample is later than the strobe, and the length of their gates
LINE, LINE_UM = 3, 2.1  # of the line; an odd number, and so few for their energy
STROBE = 13e-9  # s from a rise of clk to the strobe, the most
STROBE_TYPICAL = 6.6e-9


def interface() -> Circuit:
    """Pins hold en clk convert sample strobe reset vdd vss."""
    supplies = ("vdd", "vss")

    def slow(name: str, first: str, count: int, length: float) -> tuple[Instance, ...]:
        nodes = [first, *(f"{name}_{k}" for k in range(1, count)), name]
        pairs = enumerate(zip(nodes, nodes[1:], strict=False))
        return tuple(Instance(f"{name}{k}", inverter(1, length), (a, b, *supplies)) for k, (a, b) in pairs)

    return Circuit(
        "interface",
        (*CHIP, "sample", "strobe", "reset", *supplies),
        instances=(
            Instance("drivers", non_overlap(), ("hold", "reset", "track", *supplies)),
            Instance("clkn", nand(2), ("clk", "convert", "clkn", *supplies)),
            *slow("past", "clkn", LINE, LINE_UM),
            Instance("settles", nor(2), ("clkn", "past", "settling", *supplies)),
            Instance("rests", inverter(1, LATE_UM), ("convert", "rest", *supplies)),
            Instance("fired", nor(2), ("settling", "rest", "strobe", *supplies)),
            Instance("held", nand(), ("track", "en", "heldn", *supplies)),
            Instance("holds", inverter(), ("heldn", "holds", *supplies)),
            Instance("over", nand(), ("strobe", "holds", "overn", *supplies)),
            *slow("late", "overn", LATE, LATE_UM),
            Instance("sampled", nor(2), ("overn", "late", "sample", *supplies)),
        ),
    )
