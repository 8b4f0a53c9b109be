"""CORDIC in vectoring mode, one rotation a cycle (formats: models/digital/cordic.py)."""

from pymtl3 import Bits4, Component, InPort, OutPort, Wire, clog2, concat, mk_bits, sext, trunc, update, update_ff, zext

from talbot.models.parameters.divider import ITERATIONS_MAX, cordic_angles
from talbot.rtl.messages import DivReq, div_resp
from talbot.rtl.quad_divider.angle_rtl import Fold, Unfold
from talbot.rtl.quad_divider.iterative_rtl import IterativeDivider
from talbot.rtl.sizes import check_size

RATIO_BITS = 8  # of the response; the ratio of CORDIC is 0


class AddSubtract(Component):
    """a + b, or a - b while ``subtract``: one adder."""

    def construct(s, bits):
        s.a = InPort(bits)
        s.b = InPort(bits)
        s.subtract = InPort()
        s.out = OutPort(bits)

        @update
        def up_out():
            s.out @= s.a + (s.b ^ sext(s.subtract, bits)) + zext(s.subtract, bits)


class Rotation(Component):
    """Rotate (x, y) by atan(2^-(i + 1)) towards the x axis and add ``angle`` to z. Shifts round down."""

    def construct(s, fraction):
        x_bits, y_bits, z_bits = 9 + fraction, 10 + fraction, 7 + fraction
        s.i = InPort(4)
        s.angle = InPort(5 + fraction)
        s.x = InPort(x_bits)
        s.y = InPort(y_bits)
        s.z = InPort(z_bits)
        s.x_out = OutPort(x_bits)
        s.y_out = OutPort(y_bits)
        s.z_out = OutPort(z_bits)

        wide, half_bits = y_bits + fraction, x_bits - 1
        s.below = Wire()
        s.sum_x = AddSubtract(x_bits)
        s.sum_y = AddSubtract(y_bits)
        s.sum_z = AddSubtract(z_bits)

        s.below //= s.y[y_bits - 1]
        s.sum_x.a //= s.x
        s.sum_y.a //= s.y
        s.sum_z.a //= s.z
        s.sum_x.subtract //= s.below
        s.sum_y.subtract //= lambda: ~s.below
        s.sum_z.subtract //= s.below
        s.x_out //= s.sum_x.out
        s.y_out //= s.sum_y.out
        s.z_out //= s.sum_z.out

        @update
        def up_shift():
            s.sum_x.b @= trunc(sext(s.y[1:y_bits], wide) >> zext(s.i, wide), x_bits)
            s.sum_y.b @= zext(s.x[1:x_bits] >> zext(s.i, half_bits), y_bits)
            s.sum_z.b @= zext(s.angle, z_bits)


class NearestEven(Component):
    """z rounded to the nearest integer, ties to even; signed."""

    def construct(s, fraction):
        s.z = InPort(7 + fraction)
        s.index = OutPort(8)

        Low = mk_bits(fraction - 1)
        s.up = Wire()

        @update
        def up_index():
            s.up @= s.z[fraction - 1] & ((s.z[0 : fraction - 1] != Low(0)) | s.z[fraction])
            s.index @= sext(s.z[fraction : fraction + 7], 8) + zext(s.up, 8)


class CordicDatapath(Component):
    """The registers of the folded vector and its angle, and one rotation."""

    def construct(s, iterations):
        x_bits, y_bits, z_bits = 9 + iterations, 10 + iterations, 7 + iterations
        angle_bits = 5 + iterations
        at_bits = clog2(ITERATIONS_MAX * angle_bits)
        X, Y, Z, Fraction = mk_bits(x_bits), mk_bits(y_bits), mk_bits(z_bits), mk_bits(iterations)

        s.load = InPort()
        s.step = InPort()
        s.last = OutPort()
        s.recv_msg = InPort(DivReq)
        s.noise_floor = InPort(8)
        s.send_msg = OutPort(div_resp(RATIO_BITS))

        s.fold = Fold()
        s.rotation = Rotation(iterations)
        s.nearest = NearestEven(iterations)
        s.unfold = Unfold(RATIO_BITS)
        s.octant = Wire(3)
        s.amp_valid = Wire()
        s.larger = Wire(9)
        s.x = Wire(X)
        s.y = Wire(Y)
        s.z = Wire(Z)
        s.i = Wire(4)
        s.angles = Wire(ITERATIONS_MAX * angle_bits)
        s.at = Wire(at_bits)

        s.fold.msg //= s.recv_msg
        s.fold.noise_floor //= s.noise_floor
        s.rotation.i //= s.i
        s.rotation.x //= s.x
        s.rotation.y //= s.y
        s.rotation.z //= s.z
        for k in range(ITERATIONS_MAX):
            s.angles[k * angle_bits : (k + 1) * angle_bits] //= cordic_angles(iterations)[k] if k < iterations else 0
        s.nearest.z //= s.z
        s.unfold.octant //= s.octant
        s.unfold.larger //= s.larger
        s.unfold.amp_valid //= s.amp_valid
        s.unfold.ratio //= 0
        s.unfold.index //= s.nearest.index
        s.unfold.msg //= s.send_msg

        @update
        def up_iteration():
            s.last @= s.i == Bits4(iterations - 1)
            s.at @= zext(s.i, at_bits) * angle_bits
            s.rotation.angle @= s.angles[s.at : s.at + angle_bits]

        @update_ff
        def up_request():
            if s.reset:
                s.octant <<= 0
                s.amp_valid <<= 0
                s.larger <<= 0
            elif s.load:
                s.octant <<= s.fold.octant
                s.amp_valid <<= s.fold.amp_valid
                s.larger <<= s.fold.larger

        @update_ff
        def up_vector():
            if s.reset:
                s.x <<= X(0)
                s.y <<= Y(0)
                s.z <<= Z(0)
                s.i <<= Bits4(0)
            elif s.load:
                s.x <<= concat(s.fold.larger, Fraction(0))
                s.y <<= zext(concat(s.fold.smaller, Fraction(0)), Y)
                s.z <<= Z(0)
                s.i <<= Bits4(0)
            elif s.step:
                s.x <<= s.rotation.x_out
                s.y <<= s.rotation.y_out
                s.z <<= s.rotation.z_out
                s.i <<= s.i + Bits4(1)


class Cordic(IterativeDivider):
    """The phase by CORDIC, without a ratio. iterations: 4..16, also the number of fraction bits."""

    def construct(s, iterations=10):
        check_size(iterations=iterations)
        super().construct(CordicDatapath(iterations), RATIO_BITS)
