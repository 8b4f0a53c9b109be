"""Light fields from a picture with disparity: sub-pixel places, occlusion, the second picture."""

import numpy as np
import pytest
from skimage.data import stereo_motorcycle

from talbot.models.scene import Sampling, Scene, load, resample, warp
from talbot.models.scene.views import Pictured, Second, Shifted, view


def _ramp(rows, cols):
    return 0.2 + 0.01 * np.arange(cols)[None, :] + 0.005 * np.arange(rows)[:, None]


def test_constant_disparity_is_an_exact_shift_of_a_ramp():
    image = _ramp(20, 30)
    out, surface = view(image, np.full((20, 30), 0.37), 1.0, -2.0)
    np.testing.assert_allclose(out[3:-3, 3:-3], (image + 0.37 * 0.005 - 0.74 * 0.01)[3:-3, 3:-3], atol=1e-12)
    np.testing.assert_array_equal(surface, 0.37)


def test_cubic_reproduces_pixels_and_quadratics():
    image = (np.arange(12.0) ** 2)[None, :] * np.ones((9, 1))
    assert warp.cubic(image, 4.0, 7.0) == 49
    np.testing.assert_allclose(warp.cubic(image, 4.5, 6.25), 6.25**2, atol=1e-12)


def _box():
    """A bright near square (disparity 3) ahead of a dark far ramp (disparity -1)."""
    image, disparity = _ramp(40, 60), np.full((40, 60), -1.0)
    image[15:25, 25:35], disparity[15:25, 25:35] = 0.9, 3.0
    return image, disparity


def test_nearer_surface_hides_the_farther_one():
    image, disparity = _box()
    out, surface = view(image, disparity, 0.0, 1.0, use=warp.unmixed(disparity))
    # The square moves 3 px to the left, the background 1 px to the right.
    assert (out[16:24, 23:31] > 0.85).all() and (surface[16:24, 22:32] == 3).all()
    # Uncovered: columns 32..35. They show the background, not the square.
    assert (surface[16:24, 32:36] == -1).all() and (out[16:24, 32:36] < 0.7).all()


def test_uncovered_parts_come_from_the_second_picture():
    image, disparity = _box()
    hidden = _ramp(40, 60)
    # A right picture 2 view steps away: what the first sees at x, it shows at x - 2 d.
    right = np.empty_like(image)
    for x in range(60):
        right[:, x] = hidden[:, min(max(x - 2, 0), 59)]
    right[15:25, 19:29] = 0.9
    second = Second(right, disparity, 2.0, 0.0)
    with_second, _ = view(image, disparity, 0.0, 1.0, second, warp.unmixed(disparity))
    without, _ = view(image, disparity, 0.0, 1.0, None, warp.unmixed(disparity))
    truth, _ = view(hidden, np.full((40, 60), -1.0), 0.0, 1.0)
    part = np.s_[16:24, 33:36]
    assert np.abs(with_second - truth)[part].max() < 1e-9
    assert np.abs(without - truth)[part].max() > 1e-3


def test_the_pair_predicts_its_own_second_picture():
    """The first picture warped by the whole baseline is the second: better where the second fills the holes."""
    left, right, measured = stereo_motorcycle()
    left, right = (resample.linear(p).astype(float) for p in (left, right))
    measured = np.ascontiguousarray(measured, float)
    unknown = ~np.isfinite(measured)
    measured[unknown] = 0
    warp.fill_rows(measured, unknown)
    use = warp.unmixed(measured / 10)
    second = Second(right, measured, 1.0, 0.0)
    psnr = []
    for other in (None, second):
        out, _ = view(left, measured, 0.0, 1.0, other, use)
        psnr.append(-10 * np.log10(np.mean((out - right)[20:-20, 20:-80] ** 2)))
    assert psnr[0] > 24 and psnr[1] > psnr[0] + 3


def test_holes_without_any_surface_are_filled():
    disparity = np.array([[np.inf, 1.0, np.inf, np.inf, -2.0, np.inf], [np.inf] * 6])
    hole = ~np.isfinite(disparity)
    disparity[hole] = 0
    warp.fill_rows(disparity, hole)
    np.testing.assert_array_equal(disparity, [[1, 1, -2, -2, -2, -2], [-2] * 6])


def test_light_field_cuts_its_margin_off():
    image = _ramp(26, 36)
    seen = Pictured(image, np.full((26, 36), 1.0), Sampling(20, 30), margin=3)
    whole = Scene("plane", 5, None, image[3:23, 3:33], render=seen).light_field
    assert whole.shape == (5, 5, 20, 30)
    np.testing.assert_allclose(whole[2, 4], image[3:23, 5:35], atol=1e-12)
    np.testing.assert_allclose(whole[0, 2], image[1:21, 3:33], atol=1e-12)


def test_some_pixels_of_a_view_are_those_of_the_whole():
    """Holes too, which are filled from beyond what is wanted."""
    sampling = Sampling(120, 150)
    seen = load("motorcycle", sampling).render
    wanted = np.zeros(sampling.shape, bool)
    wanted[40:44], wanted[80:90, 30:70] = True, True
    for dv, du in ((0.0, 0.0), (1.3, -2.4), (2.4, 2.4), (0.0, -1.0)):
        for part, whole in zip(seen(wanted)(dv, du), seen(wanted | ~wanted)(dv, du), strict=True):
            np.testing.assert_array_equal(part[wanted], whole[wanted])


@pytest.mark.parametrize("disparity", [0.37, -1.0, 2.6, 30.0])
def test_a_plane_is_the_picture_shifted(disparity):
    rng = np.random.default_rng(1)
    image = rng.random((13, 37)) * rng.choice([0, 1, 16], (13, 37))  # the interpolation overshoots both ends
    shifted = Shifted(image, disparity)(np.ones(image.shape, bool))
    for dv in (-2.0, -0.5, 0.0, 1.7):
        for du in (-1.25, 0.0, 2.0):
            seen, surface = shifted(dv, du)
            want, _ = view(image, np.full(image.shape, disparity), dv, du)
            np.testing.assert_array_equal(seen, want)
            assert (surface == disparity).all()
