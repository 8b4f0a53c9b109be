"""Restoring division, digit by digit. Every variant has the same state and updates it by the same digits."""

from functools import cache

from pymtl3 import (
    Bits1,
    Bits2,
    Bits3,
    Bits9,
    Bits11,
    Bits12,
    Component,
    InPort,
    OutPort,
    Wire,
    concat,
    mk_bits,
    mk_bitstruct,
    trunc,
    update,
    zext,
)


@cache
def div_state(quotient_bits: int) -> type:
    """Return the state of a division: larger * (value of quotient) + rest = smaller, and 0 <= rest <= larger.

    rest = larger only for |x| = |y| (and for zero): then every digit is the highest, and the ratio saturates.
    """
    return mk_bitstruct(
        f"DivState_{quotient_bits}",
        {"octant": Bits3, "amp_valid": Bits1, "larger": Bits9, "rest": Bits9, "quotient": mk_bits(quotient_bits)},
    )


class Radix2Digit(Component):
    """One bit: 2 rest - larger, if that is not negative."""

    digit_bits = 1

    def construct(s, quotient_bits):
        State = div_state(quotient_bits)
        s.in_state = InPort(State)
        s.out_state = OutPort(State)

        kept = quotient_bits - 1
        s.twice = Wire(11)
        s.less = Wire(11)
        s.rest = Wire(9)

        @update
        def up_digit():
            s.twice @= concat(Bits1(0), s.in_state.rest, Bits1(0))
            s.less @= s.twice - zext(s.in_state.larger, Bits11)
            s.rest @= trunc(s.twice if s.less[10] else s.less, Bits9)
            s.out_state @= State(
                s.in_state.octant,
                s.in_state.amp_valid,
                s.in_state.larger,
                s.rest,
                concat(s.in_state.quotient[0:kept], ~s.less[10]),
            )


class Radix4Digit(Component):
    """Two bits: larger, 2 larger and 3 larger are subtracted from 4 rest in parallel."""

    digit_bits = 2

    def construct(s, quotient_bits):
        State = div_state(quotient_bits)
        s.in_state = InPort(State)
        s.out_state = OutPort(State)

        kept = quotient_bits - 2
        s.once = Wire(12)
        s.rest0 = Wire(12)
        s.rest1 = Wire(12)
        s.rest2 = Wire(12)
        s.rest3 = Wire(12)
        s.fits1 = Wire()
        s.fits2 = Wire()
        s.fits3 = Wire()
        s.rest = Wire(9)
        s.bits = Wire(2)

        @update
        def up_rests():
            s.once @= zext(s.in_state.larger, Bits12)
            s.rest0 @= concat(Bits1(0), s.in_state.rest, Bits2(0))
            s.rest1 @= s.rest0 - s.once
            s.rest2 @= s.rest0 - (s.once << Bits12(1))
            s.rest3 @= s.rest0 - (s.once + (s.once << Bits12(1)))
            s.fits1 @= ~s.rest1[11]
            s.fits2 @= ~s.rest2[11]
            s.fits3 @= ~s.rest3[11]

        @update
        def up_digit():
            s.rest @= trunc(s.rest3 if s.fits3 else s.rest2 if s.fits2 else s.rest1 if s.fits1 else s.rest0, Bits9)
            s.bits @= concat(s.fits2, s.fits3 | (s.fits1 & ~s.fits2))
            s.out_state @= State(
                s.in_state.octant,
                s.in_state.amp_valid,
                s.in_state.larger,
                s.rest,
                concat(s.in_state.quotient[0:kept], s.bits),
            )
