"""Binary gradients against Eq. A.1 to A.3 by loops."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.models.recognition import gradient

PICTURE = np.random.default_rng(1).integers(0, 256, (7, 9)).astype(np.uint8)


def by_loops(p, threshold):
    """Eq. A.1, pixel by pixel."""
    out = np.zeros(p.shape, bool)
    p = p.astype(int)
    for y in range(p.shape[0]):
        for x in range(p.shape[1]):
            here, left, top = p[y, x], p[y, max(x - 1, 0)], p[max(y - 1, 0), x]
            out[y, x] = max(abs(here - left), abs(here - top), abs(left - top)) > threshold
    return out


@pytest.mark.parametrize("threshold", (0, 40, 128, 255))
def test_spatial_is_equation_a1(threshold):
    assert np.array_equal(gradient.spatial(PICTURE, threshold), by_loops(PICTURE, threshold))
    stack = np.stack([PICTURE, PICTURE[::-1]])
    assert np.array_equal(gradient.spatial(stack, threshold)[1], by_loops(PICTURE[::-1], threshold))


def test_an_edge_is_fattened_by_the_third_difference():
    """Thesis Sec. A.3.1: |L - T| alone activates a pixel that equals a neighbour."""
    corner = np.array([[5, 9], [0, 9]])  # P = T = 9, L = 0
    assert gradient.spatial(corner, 8)[1, 1]
    assert not gradient.spatial(np.full((4, 4), 7), 0).any()


def test_temporal_is_equation_a2():
    now, before = gradient.spatial(PICTURE, 90), gradient.spatial(PICTURE[:, ::-1], 90)
    assert np.array_equal(gradient.temporal(now, before), np.maximum(0, np.abs(now.astype(int) - before)) > 0)
    with pytest.raises(ParameterError, match="before"):
        gradient.temporal(now, before[:2])


def test_more_bits_refine_one():
    one = gradient.levels(PICTURE, 1, 90)
    assert np.array_equal(one > 0, gradient.spatial(PICTURE, 90))
    for bits in (2, 4, 8):
        more = gradient.levels(PICTURE, bits, 90)
        assert more.max() <= 2**bits - 1 and np.array_equal(more >= 1 << bits - 1, one > 0)


def test_power_is_equation_a3_with_the_ratios_of_the_thesis():
    """Sec. A.4.2: 8 bits take more than 80 times, 4 bits 6 times, and 7 % of 8 bits, where a tenth is active."""
    one, four, eight = (gradient.power(bits, 1024, 0.1) for bits in (1, 4, 8))
    assert one == pytest.approx(1024 * (2 * 0.0024e-6 + 0.1 * 0.0195e-6))
    assert (
        eight / one > 80 and four / one == pytest.approx(6, abs=0.1) and four / eight == pytest.approx(0.07, abs=0.01)
    )
