"""Depth from coded light: exact inside the gate, blind outside it, as Eq. 5.2's taps never are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.models.parameters import ElectricalParameters, ParameterError
from talbot.models.pixel.time_of_flight import code_correlation, demodulate, tap_depths, tap_functions
from talbot.models.reconstruct.coded import coded_depth

CODE = ElectricalParameters(code=31, chip_rate=250e6, code_delay=1.4e-8, contrast=0.7)
SINE = ElectricalParameters(f_mod=25e6, contrast=0.7)
ENDS = tap_depths(CODE)[[0, -1]]


def msequence(taps, length):
    """Chips of a shift register, +-1."""
    state, out = [1] * max(taps), []
    for _ in range(length):
        out.append(state[-1])
        state = [state[taps[0] - 1] ^ state[taps[1] - 1], *state[:-1]]
    return 1 - 2 * np.array(out)


def test_the_correlation_is_that_of_an_m_sequence():
    """Correlated chip by chip, at fractions of one: x**5 + x**2 + 1 and x**7 + x + 1."""
    for taps, length in (((5, 3), 31), ((7, 6), 127)):
        light, fine = msequence(taps, length), 20
        held = np.repeat(light, fine).astype(float)
        for shift in (0, 7, 20, 33, 200, -11):
            own = np.mean(held * np.roll(held, shift))
            assert code_correlation(shift / fine / 1e8, length, 1e8) == pytest.approx(own, abs=1e-9)


@given(st.floats(ENDS[0] + 0.01, ENDS[1] - 0.01), st.floats(5, 200), st.floats(0, 300))
def test_depth_within_the_gate_whatever_is_before_it(depth, bright, scatter):
    taps = np.array([[bright * tap(depth) + scatter * tap(ENDS[0] - 0.7)] for tap in tap_functions(CODE)])
    found = coded_depth(taps, CODE, 0.1)
    assert found.depth[0] == pytest.approx(depth, abs=1e-3) and found.sure[0]
    assert found.amplitude[0] == pytest.approx(bright * CODE.contrast / 2, rel=1e-2)


def test_a_sine_mixes_what_is_before():
    taps = np.array([100 * tap(3.0) + 100 * tap(1.0) for tap in tap_functions(SINE)])
    alone = np.array([100 * tap(3.0) for tap in tap_functions(SINE)])
    assert abs(demodulate(taps)[0] - demodulate(alone)[0]) > 0.5


def test_light_from_outside_the_gate_alone_is_not_sure():
    for depth in (0.5, ENDS[0] - 0.7, ENDS[1] + 0.7, 8.0):
        taps = np.array([[100 * tap(depth)] for tap in tap_functions(CODE)])
        assert not coded_depth(taps, CODE, 1.0).sure[0]


@pytest.mark.parametrize("electrical, noise, message", [(SINE, 1.0, "code = 0"), (CODE, 0.0, "noise = 0")])
def test_what_is_refused(electrical, noise, message):
    with pytest.raises(ParameterError, match=message):
        coded_depth(np.zeros((4, 1)), electrical, noise)


@pytest.mark.parametrize("chips", [1, 3, 8, 100])
def test_a_code_has_a_length_that_there_is(chips):
    with pytest.raises(ParameterError, match="code = "):
        ElectricalParameters(code=chips)
