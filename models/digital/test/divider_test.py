from decimal import Decimal, getcontext

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.digital.cordic import cordic, nearest_even, rotate
from talbot.models.digital.divider import QuadResult, fold, phase_error, quad_divide
from talbot.models.parameters import ParameterError
from talbot.models.parameters.divider import cordic_angles, phase_thresholds

SAMPLES = np.arange(-256, 256)
X, Y = np.meshgrid(SAMPLES, SAMPLES)
NONZERO = (X != 0) | (Y != 0)
WIDTHS = range(4, 17)


def exact_atan(q, terms=120):
    """atan(q) for 0 < q <= 1 to 60 digits: Euler's series."""
    term = q / (1 + q * q)
    total = term
    for n in range(1, terms * 2):
        term *= 2 * n * q * q / ((2 * n + 1) * (1 + q * q))
        total += term
    return total


def worst_and_rms(result):
    error = phase_error(result.phase, X, Y)[NONZERO]
    return np.abs(error).max(), np.sqrt((error**2).mean())


def fields(result):
    return [getattr(result, name) for name in QuadResult.__dataclass_fields__]


def test_octant_by_cross_products():
    rays = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)]
    octant = quad_divide(X, Y).octant
    for k, (a, b) in enumerate(rays):
        c, d = rays[(k + 1) % 8]
        inside = (a * Y - b * X >= 0) & (c * Y - d * X < 0)
        assert (octant[NONZERO] == k).tolist() == inside[NONZERO].tolist(), k


@pytest.mark.parametrize("n_frac", WIDTHS)
def test_ratio_is_the_floor_of_the_quotient(n_frac):
    ratio = quad_divide(X, Y, n_frac).ratio.astype(np.int64)
    small, large = np.minimum(abs(X), abs(Y)), np.maximum(abs(X), abs(Y))
    equal = (small == large) & NONZERO
    assert (ratio[equal] == 2**n_frac - 1).all()
    rest = NONZERO & ~equal
    assert (ratio * large <= small << n_frac)[rest].all() and ((ratio + 1) * large > small << n_frac)[rest].all()


def test_zero_amplitude_and_noise_floor():
    for floor in (0, 1, 100, 255):
        result = quad_divide(X, Y, 8, floor)
        large = np.maximum(abs(X), abs(Y))
        assert (result.zero == ~NONZERO).all() and (result.amp == np.minimum(large, 255)).all()
        assert (result.amp_valid == ((large >= floor) & NONZERO)).all()
    for result in [quad_divide(0, 0, n) for n in WIDTHS] + [cordic(0, 0, n) for n in WIDTHS]:
        assert [int(v) for v in fields(result)] == [0, 0, 1, 0, 0, 0]


@pytest.mark.parametrize(
    "x, y, octant, ratio, phase",
    [
        (255, 0, 0, 0, 0),
        (1, 1, 1, 255, 32),
        (0, 9, 2, 0, 64),
        (-7, 7, 3, 255, 96),
        (-256, 0, 4, 0, 128),
        (-256, -256, 5, 255, 160),
        (0, -1, 6, 0, 192),
        (200, -200, 7, 255, 224),
        (100, 50, 0, 128, 19),
        (-2, -1, 4, 128, 147),
        (1, -256, 6, 1, 192),
        (255, -3, 7, 3, 255),
    ],
)
def test_by_hand(x, y, octant, ratio, phase):
    result = quad_divide(x, y)
    assert (int(result.octant), int(result.ratio), int(result.phase)) == (octant, ratio, phase)
    assert int(cordic(x, y).octant) == octant and int(cordic(x, y).ratio) == 0


@pytest.mark.parametrize("n_frac", WIDTHS)
def test_thresholds_in_60_digits(n_frac):
    getcontext().prec = 60
    pi = 4 * exact_atan(Decimal(1), 200)
    for k, threshold in enumerate(phase_thresholds(n_frac), start=1):
        edge = 2 * pi * (2 * k - 1) / 512
        assert threshold >= 0

        def reached(ratio, edge=edge):
            """Is the centre of the cell of ``ratio`` at ``edge`` or beyond it?"""
            return exact_atan((Decimal(ratio) + Decimal(1) / 2) / 2**n_frac) >= edge

        assert threshold == 2**n_frac - 1 or reached(threshold)
        assert threshold == 0 or not reached(threshold - 1)


@pytest.mark.parametrize(
    "n_frac, bound", [(4, 1.6), (5, 1.05), (6, 0.81), (7, 0.64), (8, 0.75), (12, 0.51), (16, 0.501)]
)
def test_phase_of_every_input(n_frac, bound):
    worst, rms = worst_and_rms(quad_divide(X, Y, n_frac))
    print(f"n_frac {n_frac}: worst {worst:.4f} LSB, RMS {rms:.4f} LSB")
    assert worst < bound and rms < 0.7 * bound


@pytest.mark.parametrize("iterations, bound", [(4, 3.0), (6, 1.2), (8, 0.75), (10, 0.54), (16, 0.501)])
def test_cordic_phase_of_every_input(iterations, bound):
    worst, rms = worst_and_rms(cordic(X, Y, iterations))
    print(f"{iterations} iterations: worst {worst:.4f} LSB, RMS {rms:.4f} LSB")
    assert worst < bound and rms < 0.7 * bound


@pytest.mark.parametrize("divide", [quad_divide, cordic])
def test_a_quarter_turn_adds_64(divide):
    inside = NONZERO & (X > -256) & (Y > -256)
    x, y = X[inside], Y[inside]
    here, turned = divide(x, y), divide(-y, x)
    assert (turned.phase == here.phase + np.uint8(64)).all() and (turned.octant == (here.octant + 2) % 8).all()
    assert (turned.ratio == here.ratio).all() and (turned.amp == here.amp).all()


@pytest.mark.parametrize("iterations", [4, 10, 16])
def test_cordic_state_stays_in_its_stated_range(iterations):
    _, x, y = fold(X, Y)
    state = x << iterations, y << iterations, np.zeros_like(x)
    one = 1 << iterations
    for i, angle in enumerate(cordic_angles(iterations), start=1):
        state = rotate(*state, i, angle)
        x, y, z = state
        assert x.min() >= 0 and x.max() < 421.6 * one and -128 * one <= y.min() and y.max() <= 256 * one
        assert -8 * one < z.min() and z.max() < 40 * one


def test_cordic_angles_in_60_digits():
    getcontext().prec = 60
    pi = 4 * exact_atan(Decimal(1), 200)
    for iterations in WIDTHS:
        for i, angle in enumerate(cordic_angles(iterations), start=1):
            exact = exact_atan(Decimal(2) ** -i) * 128 / pi * 2**iterations
            assert abs(angle - exact) < Decimal("0.5")


@given(st.integers(-(2**23), 2**23), st.integers(1, 16))
def test_nearest_even(z, fraction):
    assert nearest_even(np.array(z), fraction) == round(z / 2**fraction)


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.tuples(st.integers(-256, 255), st.integers(-256, 255)), min_size=1, max_size=8),
    st.integers(4, 16),
    st.integers(0, 255),
)
def test_arrays_equal_scalars_and_keep_their_shape(pairs, n, floor):
    pairs = np.array(pairs, np.int16)[:, None]
    for divide in (quad_divide, cordic):
        whole = divide(pairs[..., 0], pairs[..., 1], n, floor)
        for i, (x, y) in enumerate(pairs[:, 0].tolist()):
            single = divide(x, y, n, floor)
            for a, b in zip(fields(whole), fields(single)):
                assert a.shape == (len(pairs), 1) and b.shape == () and a[i, 0] == b and a.dtype == b.dtype


@pytest.mark.parametrize(
    "arguments, field",
    [
        ((256, 0), "x = 256"),
        ((0, -257), "y = -257"),
        ((0.5, 0), "x of type float64"),
        ((0, 0, 3), "= 3"),
        ((0, 0, 17), "= 17"),
        ((0, 0, 8, 256), "noise_floor = 256"),
        ((np.array([0, 300]), 0), "x = 300"),
        ((True, 0), "x of type bool"),
        ((0, 0, 8, -1), "noise_floor = -1"),
    ],
)
def test_refuses(arguments, field):
    for divide in (quad_divide, cordic):
        with pytest.raises(ParameterError, match=field):
            divide(*arguments)
