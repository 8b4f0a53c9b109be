"""The combinational logic before and after the division: the vector folded into its octant, the angle unfolded."""

from pymtl3 import Bits5, Bits8, Bits9, Component, InPort, OutPort, Wire, clog2, concat, mk_bits, sext, update, zext

from talbot.models.parameters.divider import phase_thresholds
from talbot.rtl.messages import DivReq, div_resp


class Fold(Component):
    """The octant of (x, y), and |x|, |y| in order of size.

    Rotated into the first quadrant, a vector other than zero has u > 0 and v >= 0.
    """

    def construct(s):
        s.msg = InPort(DivReq)
        s.noise_floor = InPort(8)
        s.octant = OutPort(3)
        s.larger = OutPort(9)
        s.smaller = OutPort(9)
        s.amp_valid = OutPort()

        s.abs_x = Wire(9)
        s.abs_y = Wire(9)
        s.lower = Wire()
        s.odd = Wire()
        s.u = Wire(9)
        s.v = Wire(9)
        s.second = Wire()

        @update
        def up_quadrant():
            s.abs_x @= ~s.msg.x + Bits9(1) if s.msg.x[8] else s.msg.x
            s.abs_y @= ~s.msg.y + Bits9(1) if s.msg.y[8] else s.msg.y
            s.lower @= s.msg.y[8] | ((s.msg.y == Bits9(0)) & s.msg.x[8])
            if s.msg.y == Bits9(0):
                s.odd @= 0
            elif s.lower:
                s.odd @= ~s.msg.x[8]
            else:
                s.odd @= s.msg.x[8] | (s.msg.x == Bits9(0))

        @update
        def up_octant():
            s.u @= s.abs_y if s.odd else s.abs_x
            s.v @= s.abs_x if s.odd else s.abs_y
            s.second @= (s.v >= s.u) & (s.u != Bits9(0))
            s.octant @= concat(s.lower, s.odd, s.second)
            s.larger @= s.v if s.second else s.u
            s.smaller @= s.u if s.second else s.v
            s.amp_valid @= (s.larger != Bits9(0)) & (s.larger >= zext(s.noise_floor, 9))


class PhaseIndex(Component):
    """The phase table: the number of thresholds, of 32, that the ratio has reached, by binary search."""

    def construct(s, n_frac):
        s.ratio = InPort(n_frac)
        s.index = OutPort(6)

        last = 32 * n_frac
        at_bits = clog2(33 * n_frac)
        s.edges = Wire(33 * n_frac)
        s.found = Wire(5)
        s.trial = Wire(5)
        s.at = Wire(at_bits)

        for k, threshold in enumerate((0, *phase_thresholds(n_frac))):  # the 0th is always reached
            s.edges[k * n_frac : (k + 1) * n_frac] //= threshold

        @update
        def up_search():
            s.found @= Bits5(0)
            s.trial @= Bits5(0)
            s.at @= 0
            for level in range(5):
                s.trial @= s.found | (Bits5(16) >> Bits5(level))
                s.at @= zext(s.trial, at_bits) * n_frac
                if s.ratio >= s.edges[s.at : s.at + n_frac]:
                    s.found @= s.trial
            s.index @= zext(s.found, 6) + zext(s.ratio >= s.edges[last : last + n_frac], 6)


class Unfold(Component):
    """The response from the octant, the ratio and the index: the angle from the octant's own axis, signed, in LSB.

    Odd octants run from their diagonal to the axis where the next one starts.
    """

    def construct(s, n_frac):
        s.octant = InPort(3)
        s.larger = InPort(9)
        s.amp_valid = InPort()
        s.ratio = InPort(n_frac)
        s.index = InPort(8)
        s.msg = OutPort(div_resp(n_frac))

        Response, Ratio = div_resp(n_frac), mk_bits(n_frac)
        s.zero = Wire()
        s.axis = Wire(8)
        s.phase = Wire(8)

        @update
        def up_phase():
            s.zero @= s.larger == Bits9(0)
            s.axis @= concat(s.octant + zext(s.octant[0], 3), Bits5(0))
            if s.zero:
                s.phase @= Bits8(0)
            elif s.octant[0]:
                s.phase @= s.axis - s.index
            else:
                s.phase @= s.axis + s.index

        @update
        def up_msg():
            s.msg @= Response(
                s.octant,
                Ratio(0) if s.zero else s.ratio,
                s.zero,
                s.phase,
                s.amp_valid,
                s.larger[0:8] | sext(s.larger[8], 8),
            )
