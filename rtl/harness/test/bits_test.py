"""The fast paths through Bits give the same values and errors as PyMTL's methods."""

import operator
import random

import pytest
from pymtl3 import Bits, Bits1, Bits8, mk_bits, mk_bitstruct

from talbot.rtl.harness.bits import SHORT, SLOW

Pair = mk_bitstruct("Pair", {"high": Bits1, "low": mk_bits(7)})
WIDTHS = 1, 7, 8, 64, 384
NUMBERS = [0, 1, -1, -128, -129, 127, 128, 255, 256, 2**63, 2**64 - 1, 2**64, 2**400, True, False]
OTHERS = [Pair(1, 5), None, "1", 1.0, Bits8(1) == 1]
PLACES = [slice(0, 1), slice(1, 8), slice(0, 8, 1), slice(3, 3), slice(5, 2), slice(-1, 4), slice(None, 4)]
PLACES += [slice(2, None), slice(True, 3), slice(Bits8(0), 3), *NUMBERS, Bits8(5), Bits1(0)]


def outcome(method, bits, *operands):
    """Return the result of a call and the value it leaves in ``bits``, or the error it raises."""
    try:
        made = method(bits, *operands)
    except Exception as error:
        return type(error), str(error)
    left = [getattr(bits, name, None) for name in ("_nbits", "_uint", "_next")]
    return made is bits, (made.nbits, operator.index(made)) if isinstance(made, Bits) else made, type(made), left


@pytest.mark.parametrize("name", [name for name in SHORT if name not in ("__init__", "__int__", "__getitem__")])
def test_operations_of_every_kind_of_operand(name):
    pick = random.Random(1)
    for width in WIDTHS:
        kind = mk_bits(width)
        values = [kind(0), kind((1 << width) - 1), *(kind(pick.getrandbits(width)) for _ in range(9))]
        for value in values:
            for other in [*values, *NUMBERS, *OTHERS, *(mk_bits(w)(1) for w in WIDTHS), Bits(width, 1)]:
                assert outcome(SHORT[name], value.clone(), other) == outcome(SLOW[name], value.clone(), other)


@pytest.mark.parametrize("width", WIDTHS)
def test_bits_of_every_kind_of_place(width):
    value = mk_bits(width)(random.Random(width).getrandbits(width))
    for place in PLACES:
        assert outcome(SHORT["__getitem__"], value, place) == outcome(SLOW["__getitem__"], value, place)


@pytest.mark.parametrize("width", [*WIDTHS, 0, 1024, True, 8.0])
def test_made_of_every_kind_of_value(width):
    for value in [*NUMBERS, *OTHERS, Bits8(9)]:
        for cut in (False, True):
            short, slow = object.__new__(Bits), object.__new__(Bits)
            assert outcome(SHORT["__init__"], short, width, value, cut) == outcome(
                SLOW["__init__"], slow, width, value, cut
            )


def test_a_number_is_an_int():
    for value in (Bits8(7), Bits8(7) == 7, Bits1(1)):
        assert outcome(SHORT["__int__"], value) == outcome(SLOW["__int__"], value)
