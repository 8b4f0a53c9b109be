"""The frame of the chip's bench in PyMTL's simulation of the RTL, with the front end in Python at its pins."""

from typing import Any

import numpy as np

from talbot.models.digital.host import frame_writes
from talbot.models.parameters import FrameParameters
from talbot.rtl.asp_chip.test.chip_bench import ChipBench
from talbot.rtl.harness.testbench import build
from talbot.rtl.tops import build_top
from talbot.verif.bench.exposure import FRONT_END, SENSOR, TRIMS, samples

LAST_DECISION = 14  # the noise of a sample has this many values (pixels/README.md)


class FrontEndBench(ChipBench):
    """ChipBench with the imperfect converters of pixels/afe.sv."""

    def __init__(self, sim: Any, mode: str) -> None:
        self.index, self.decision = np.zeros(SENSOR.chip.lanes, int), 0
        held = FRONT_END.values(samples(), mode)
        assert FRONT_END.converter  # SENSOR has imperfect converters
        self.converter, self.shape = FRONT_END.converter, held.shape
        super().__init__(sim, SENSOR.chip.lanes, held=held)

    def sample(self) -> None:
        """Sample and hold each enabled lane."""
        super().sample()
        sim, self.decision = self.sim, -1
        for lane in (lane for lane in range(self.lanes) if sim.en[lane]):
            col = self.tile_cols * (self.lanes * int(sim.group) + lane) + int(sim.k)
            self.index[lane] = np.ravel_multi_index((int(sim.sub), int(sim.row), col), self.shape)
            self.taken[lane] = self.converter.held(self.taken[lane], lane, self.index[lane])

    def answers(self) -> int:
        """Return the comparators' outputs, one bit per lane."""
        sim, bits = self.sim, 0
        self.decision = min(self.decision + 1, LAST_DECISION)
        for lane in range(self.lanes):
            dac = int(sim.dac[8 * lane : 8 * lane + 8])
            bits |= (
                int(
                    self.converter.compare(
                        self.taken[lane], dac, bool(sim.unsigned_), lane, self.index[lane], self.decision
                    )
                )
                << lane
            )
        return bits


def pymtl_stream(frame: FrameParameters) -> bytes:
    """Return the bytes of ``frame``, one of verif.bench.exposure.FRAMES."""
    bench = FrontEndBench(build(build_top("AspChip", SENSOR)), frame.mode)
    bench.write(frame_writes(frame, TRIMS))
    bench.start()
    return bytes(bench.stream)
