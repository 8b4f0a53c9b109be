"""The interface of the chip and a lane with its amplifier: the chip's `hold`, `en` and `clk` become phases of both.

    clk        |‾|______|‾|______|‾|______|      high for 12 ns
    hold       |________|‾‾‾‾‾‾‾‾|________
    reset      |‾‾‾‾‾‾‾‾|________|‾‾‾‾‾‾‾‾      of the amplifier: ends before `track` begins, begins after its end
    strobe     |_|‾‾‾‾‾‾|_|‾‾‾‾‾‾|_|‾‾‾‾‾‾      not clk
    sample     |__________|__‾‾‾‾|________      where the lane is enabled, once its last decision is over

The chip lets a lane sample in the cycle of its last decision. `late` follows the strobe after inverters as slow as
several decisions, and the sample waits for both.
"""

from talbot.pixels.circuits.gates import inverter, nand, nor
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.circuits.support import non_overlap

CHIP = "hold", "en", "clk"
SLOW, SLOW_UM = 4, 1.4  # inverters between strobe and sample, and the length of their gates


def interface() -> Circuit:
    """Pins hold en clk sample strobe reset vdd vss."""
    supplies = ("vdd", "vss")
    slow = ["strobe", *(f"late_{k}" for k in range(1, SLOW)), "late"]
    return Circuit(
        "interface",
        (*CHIP, "sample", "strobe", "reset", *supplies),
        instances=(
            Instance("drivers", non_overlap(), ("hold", "reset", "track", *supplies)),
            Instance("fired", inverter(2), ("clk", "strobe", *supplies)),
            *(
                Instance(f"slow{k}", inverter(1, SLOW_UM), (a, b, *supplies))
                for k, (a, b) in enumerate(zip(slow, slow[1:], strict=False))
            ),
            Instance("held", nand(), ("track", "en", "heldn", *supplies)),
            Instance("over", nand(), ("strobe", "late", "overn", *supplies)),
            Instance("sampled", nor(2), ("heldn", "overn", "sample", *supplies)),
        ),
    )
