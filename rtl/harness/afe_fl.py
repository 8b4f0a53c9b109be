"""The analog front end as a PyMTL component, for the tests of single blocks: Afe of pixels/afe.sv."""

import numpy as np
import numpy.typing as npt
from pymtl3 import Component, InPort, OutPort, mk_bits, update, update_ff

from talbot.models.afe import Converter, FrontEnd
from talbot.models.parameters import MODES


class AfeFL(Component):
    """The front end over ``samples``, float64 (taps, rows, cols, 2), with the trim of ``front_end``.

    It has the ports of Afe, without ``balance``.
    """

    def construct(s, front_end: FrontEnd, samples: npt.NDArray[np.float64]) -> None:
        lanes = front_end.lanes
        s.mode, s.row, s.group, s.k, s.sub = (InPort(mk_bits(n)) for n in (2, 10, 8, 3, 2))
        s.en, s.dac = InPort(lanes), InPort(8 * lanes)
        s.hold, s.unsigned_ = InPort(), InPort()
        s.comparator = OutPort(lanes)

        s.converter = front_end.converter or Converter.ideal(lanes)
        s.values = {
            n: front_end.values(samples, mode) for n, mode in enumerate(MODES) if mode != "tof" or len(samples) == 4
        }
        s.held, s.index = np.zeros(lanes), np.zeros(lanes, np.int64)
        s.decision = OutPort(8)  # cycles since the hold; a change runs `compare` again

        @update_ff
        def sample():
            if s.hold:
                v = s.values[int(s.mode)]
                for lane in range(lanes):
                    if s.en[lane]:
                        col = front_end.tile.cols * (lanes * int(s.group) + lane) + int(s.k)
                        s.index[lane] = np.ravel_multi_index((int(s.sub), int(s.row), col), v.shape)
                        s.held[lane] = s.converter.held(v[int(s.sub), int(s.row), col], lane, s.index[lane])
                s.decision <<= 0
            elif s.decision < 14:
                s.decision <<= s.decision + 1

        @update
        def compare():
            number, bits = int(s.decision), 0
            for lane in range(lanes):
                dac = int(s.dac[8 * lane : 8 * lane + 8])
                if s.converter.compare(s.held[lane], dac, bool(s.unsigned_), lane, s.index[lane], number):
                    bits |= 1 << lane
            s.comparator @= bits

    def line_trace(s) -> str:
        return f"{'hold' if s.hold else '    '} {s.dac} > {s.comparator}"
