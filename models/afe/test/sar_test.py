"""The conversion of whole arrays against one decision after another, on ideal and on drawn converters."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.afe import Converter
from talbot.models.digital.sar import convert, decisions
from talbot.models.parameters import ConverterParameters, ParameterError

ROUGH = Converter.draw(ConverterParameters(inl=2, dnl=0.5, offset=2, noise=1.5, ktc=1, seed=7), 4)

EDGES = [x for half in np.arange(-129, 257) + 0.5 for x in (np.nextafter(half, -1e9), half, np.nextafter(half, 1e9))]


def one_by_one(v, unsigned, threshold, converter, lane, index):
    """The decisions of one sample, one at a time: (code, converted, number)."""
    held = converter.held(v, lane, index)
    lane_decisions, number = decisions(unsigned, threshold), 0
    dac = next(lane_decisions)
    while True:
        try:
            answer = bool(converter.compare(held, dac, unsigned, lane, index, number))
            number += 1
            dac = lane_decisions.send(answer)
        except StopIteration as end:
            return *end.value, number


@settings(max_examples=60, deadline=None)
@given(
    st.booleans(),
    st.integers(0, 127),
    st.sampled_from([ROUGH, Converter.ideal(4)]),
    st.lists(st.one_of(st.floats(-300, 600), st.sampled_from(EDGES)), min_size=1, max_size=20),
    st.integers(0, 2**23),
)
def test_equals_the_decisions_one_by_one(unsigned, threshold, converter, values, first):
    v, index = np.array(values), first + np.arange(len(values))
    lane = index % 4
    got = convert(v, unsigned, threshold, converter, lane, index)
    expected = [
        one_by_one(*x) for x in zip(v, [unsigned] * v.size, [threshold] * v.size, [converter] * v.size, lane, index)
    ]
    assert list(zip(*got)) == expected


@pytest.mark.parametrize("unsigned", [False, True])
@pytest.mark.parametrize("threshold", [0, 1, 10, 127])
def test_ideal_is_rounding_and_equals_the_search_at_every_level(unsigned, threshold):
    v = np.array(EDGES + [0.0, -0.0, 5e-324, 1e300, -1e300])
    fast = convert(v, unsigned, threshold)
    searched = convert(v, unsigned, threshold, Converter.ideal(1), 0, np.arange(v.size))
    assert all((a == b).all() for a, b in zip(fast, searched))
    exact = [_round_half_up(x) for x in v]
    low = 0 if unsigned else -128
    codes = np.clip(exact, low, low + 255)
    zero = np.zeros(v.size, bool) if unsigned else np.abs(codes) < threshold
    assert (fast.codes == np.where(zero, 0, codes)).all()
    assert (fast.converted == ~zero).all()


def _round_half_up(x):
    """floor(x + 1/2) in exact integer arithmetic."""
    p, q = float(x).as_integer_ratio()
    return int(np.clip((2 * p + q) // (2 * q), -1000, 1000))


def test_no_code_lies_inside_the_window():
    v = np.random.default_rng(1).normal(0, 30, 20_000)
    got = convert(v, False, 12, ROUGH, np.arange(v.size) % 4, np.arange(v.size))
    assert ((got.codes == 0) | (np.abs(got.codes) >= 12)).all()
    assert (got.codes[~got.converted] == 0).all() and (got.codes[got.converted] == 0).any()
    assert (got.decisions == np.where(got.converted, 10, 2)).all()


def test_counts_decisions_without_a_window():
    v = np.linspace(-3, 3, 7)
    assert (convert(v, False, 0).decisions == 8).all() and convert(v, False, 0).converted.all()
    assert (convert(v, True, 100).decisions == 8).all() and convert(v, True, 100).converted.all()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_refuses_what_is_no_number(value):
    with pytest.raises(ParameterError, match="finite"):
        convert(np.array([value]), False)


@pytest.mark.parametrize("threshold", [-1, 128, 1.5])
def test_refuses_a_threshold_out_of_range(threshold):
    with pytest.raises(ParameterError, match="threshold = "):
        convert(np.zeros(1), False, threshold)
