"""The analog front end as a PyMTL component: Afe of pixels/afe.sv."""

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
        every, holds, known = np.arange(lanes), [0], [None, 0]  # known: what the comparators saw last, and their bits

        @update_ff
        def sample():
            if s.hold & ~s.reset:  # gates have no values before their first reset, and any address
                v = s.values[int(s.mode)]
                for lane in range(lanes):
                    if s.en[lane]:
                        col = front_end.tile.cols * (lanes * int(s.group) + lane) + int(s.k)
                        s.index[lane] = np.ravel_multi_index((int(s.sub), int(s.row), col), v.shape)
                        s.held[lane] = s.converter.held(v[int(s.sub), int(s.row), col], lane, s.index[lane])
                holds[0] += 1
                s.decision <<= 0
            elif s.decision < 14:
                s.decision <<= s.decision + 1

        @update
        def compare():
            dac, unsigned, number = int(s.dac), bool(s.unsigned_), int(s.decision)
            if known[0] != (dac, unsigned, number, holds[0]):
                codes = np.frombuffer(dac.to_bytes(lanes, "little"), np.uint8)
                above = s.converter.compare(s.held, codes, unsigned, every, s.index, number)
                known[:] = (
                    (dac, unsigned, number, holds[0]),
                    int.from_bytes(np.packbits(above, bitorder="little"), "little"),
                )
            s.comparator @= known[1]

    def line_trace(s) -> str:
        return f"{'hold' if s.hold else '    '} {s.dac} > {s.comparator}"
