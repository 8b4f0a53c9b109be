"""Response, view weights and trim of the pixel types, to the extremes of their parameters."""

import numpy as np
import pytest

from talbot.models.parameters import OpticsParameters, ParameterError, PixelType, TileParameters
from talbot.models.pixel import (
    Ripple,
    exact,
    gains,
    measured_gains,
    optical_gains,
    residual,
    response,
    sampling_error,
    view_weights,
    vignetting,
)
from talbot.models.pixel.quadrature import sampled
from talbot.models.pixel.weights import cell_nodes, raw_weights

TYPES = TileParameters().types
GRAZING = np.deg2rad([-90, -89.9, -45, 0, 30, 89.9, 90])


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("m", [0.0, 0.7, 1.0])
@pytest.mark.parametrize("beta", [0.0, 12.0, 50.0])
def test_response_stays_in_range(dtype, m, beta):
    x, y = np.meshgrid(GRAZING.astype(dtype), GRAZING.astype(dtype))
    with np.errstate(all="raise"):
        out = response(0.3, beta, 0.7, x, y, m, 0.2)
    assert out.dtype == dtype and (out >= 0).all() and (out <= 1 + m).all()


def test_response_on_axis_is_the_formula():
    np.testing.assert_allclose(response(0.5, 12, 0, np.float64(0), np.float64(0), 0.7, 0.2), 1 + 0.7 * np.cos(0.5))


def test_float32_response_follows_float64():
    x, y = np.meshgrid(np.linspace(-0.4, 0.4, 31), np.linspace(-0.4, 0.4, 31))
    wide = response(0.3, 24, 0.7, x, y, 1.0, 0.2)
    narrow = response(0.3, 24, 0.7, x.astype(np.float32), y.astype(np.float32), 1.0, 0.2)
    assert np.abs(wide - narrow).max() < 5e-6


def test_diodes_of_a_pair_sum_to_the_common_mode():
    """2 A: no angle in the sum; and the phases 0, pi/2, pi, 3 pi/2 are a quadrature set (Eq. 3.1 prints 3 pi/4)."""
    theta = np.linspace(-0.4, 0.4, 41)
    four = [response(alpha, 18, 0.4, theta, 0.1, 0.7, 0.2) for alpha in np.arange(4) * np.pi / 2]
    np.testing.assert_allclose(four[0] + four[2], four[1] + four[3])
    np.testing.assert_allclose(four[0] + four[2], 2 * np.exp(-(theta**2 + 0.01) / 0.08))
    magnitude = np.hypot(four[0] - four[2], four[1] - four[3])
    np.testing.assert_allclose(magnitude, 0.7 * (four[0] + four[2]))
    printed = response(3 * np.pi / 4, 18, 0.4, theta, 0.1, 0.7, 0.2)
    assert np.abs(four[1] + printed - (four[0] + four[2])).max() > 0.1


def test_vignetting_of_grazing_light():
    with np.errstate(all="raise"):
        np.testing.assert_allclose(vignetting(np.tan(np.pi / 3), 0.0, 4), 0.5**4)
        assert 0 <= vignetting(np.tan(np.deg2rad(89.9)), np.float64(1e60), 4) < 1e-11


def test_nodes_measure_the_disc():
    optics = OpticsParameters(subsamples=12)
    area = sum(cell_nodes(optics, v, u)[2].sum() for v in range(5) for u in range(5))
    np.testing.assert_allclose(area, np.pi * optics.nu_max**2, rtol=1e-12)


def test_weights_converge_on_the_adaptive_quadrature():
    """Light that does not vary over the lens: only the sub-samples err, and exponentially little."""
    still = Ripple(periods=0)
    errors = [sampling_error(TYPES, OpticsParameters(subsamples=n), still).worst for n in (1, 2, 4, 8)]
    assert errors[0] < 0.1 and errors[1] < 0.03 and errors[2] < 5e-4 and errors[3] < 1e-8


def test_more_views_follow_light_that_varies():
    reference = exact(TYPES, OpticsParameters(), Ripple())
    worst = [sampling_error(TYPES, OpticsParameters(views=n), Ripple(), reference).worst for n in (1, 3, 5, 9)]
    assert worst[0] > worst[1] > worst[2] > worst[3] and worst[2] < 0.03


@pytest.mark.parametrize("beta", [0.0, 50.0])
@pytest.mark.parametrize("m", [0.0, 1.0])
def test_exact_and_sampled_agree_at_the_extremes(beta, m):
    types = (PixelType(beta, 30.0, 0.4),)
    optics = OpticsParameters(m=m, subsamples=16)
    still = Ripple(periods=0)
    np.testing.assert_allclose(sampled(types, optics, still), exact(types, optics, still), rtol=1e-7)


def test_white_scene_gives_one_on_average():
    weights = view_weights(TileParameters(), OpticsParameters())
    assert weights.shape == (24, 2, 5, 5) and (weights > 0).all()
    np.testing.assert_allclose(weights.sum((2, 3)).mean(), 1)


@pytest.mark.parametrize("sigma,low,high", [(0.15, 0.19, 0.007), (0.2, 0.04, 0.018), (0.3, -0.07, 0.029)])
def test_residual_of_a_gaussian_aperture(sigma, low, high):
    """k at beta = 12 and 24, gamma = 0, without vignetting and with full modulation."""
    optics = OpticsParameters(m=1.0, aperture_sigma=sigma, vignetting_power=0.0)
    types = (PixelType(12, 0, 0), PixelType(24, 0, 0))
    found = residual(raw_weights(types, optics))
    np.testing.assert_allclose(found, [low, high], atol=0.005)


def test_gains_null_a_flat_field():
    tile, optics = TileParameters(), OpticsParameters()
    a, b = view_weights(tile, optics).sum((2, 3)).T
    np.testing.assert_allclose(a - optical_gains(tile, optics) * b, 0, atol=1e-14)


def test_gains_are_finite_at_the_ends():
    with np.errstate(all="raise"):
        g = gains(np.array([-1.0, 0.0, 1.0]))
    np.testing.assert_allclose(g, [1 / 64, 1, 64])


def test_measured_gains_equal_the_optical_ones():
    tile, optics = TileParameters(), OpticsParameters()
    currents = view_weights(tile, optics).sum((2, 3))
    frame = currents[tile.type_map(11, 17)]  # tiles at the far edges are partial
    np.testing.assert_allclose(measured_gains(frame, tile), optical_gains(tile, optics))
    with pytest.raises(ParameterError, match="flat-field frame of types .* = 0"):
        measured_gains(np.zeros((8, 12, 2)), tile)


def test_types_that_an_array_lacks_keep_a_gain_of_1():
    tile, frame = TileParameters(), np.array([[[3.0, 2.0], [1.0, 2.0]]])
    gains = measured_gains(frame, tile)
    present = tile.type_map(1, 2)[0]
    assert gains[present] == pytest.approx([1.5, 0.5])
    assert (np.delete(gains, present) == 1).all()
