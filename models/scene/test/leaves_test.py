"""Dead leaves: views that agree with their disparity, seeds, borders."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.models.scene import Sampling, load

SAMPLING = Sampling(40, 52)


def test_views_show_what_the_disparity_says():
    """Where a leaf is alone around a pixel, another view shows its radiance moved by the disparity."""
    scene = load("leaves:5", SAMPLING)
    assert scene.disparity is not None
    y, x = np.mgrid[:40, :52].astype(float)
    alone = np.ones(scene.shape, bool)
    for dy in range(-5, 6):
        for dx in range(-5, 6):
            alone &= np.roll(scene.disparity, (dy, dx), (0, 1)) == scene.disparity
    alone[:5] = alone[-5:] = alone[:, :5] = alone[:, -5:] = False
    assert alone.sum() > 50
    # View (dv, du) shows at y what the middle one shows at y + dv d: half a step each way is still sampled finely
    see = scene.view(alone)
    for dv, du in ((1.0, -1.0), (-0.5, 2.0)):
        there, _ = see(dv, du)
        back = np.empty(scene.shape)
        for d in np.unique(scene.disparity[alone]):
            moved = load("leaves:5", SAMPLING).view(alone)(0.0, 0.0)[0]
            at = alone & (scene.disparity == d)
            back[at] = _sampled(moved, y[at] + dv * d, x[at] + du * d)
        assert np.abs(there - back)[alone].max() < 0.15 and np.abs(there - back)[alone].mean() < 0.02


def _sampled(image, y, x):
    """Linear between pixels."""
    i, j = np.floor(y).astype(int), np.floor(x).astype(int)
    b, a = y - i, x - j
    top = image[i, j] * (1 - a) + image[i, j + 1] * a
    return top * (1 - b) + (image[i + 1, j] * (1 - a) + image[i + 1, j + 1] * a) * b


def test_seeds_give_other_scenes_and_the_same_ones_again():
    first, again, other = (load(name, SAMPLING).image for name in ("leaves:1", "leaves:1", "leaves:2"))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).mean() > 0.02


def test_every_pixel_is_covered_and_depths_are_those_of_the_disparity():
    scene = load("leaves", Sampling(7, 9))
    assert scene.image.min() >= 0 and scene.depth is not None and scene.disparity is not None
    order = np.argsort(scene.depth, axis=None)
    assert (np.diff(scene.disparity.ravel()[order]) <= 1e-12).all()  # nearer is more


def test_a_seed_out_of_range():
    with pytest.raises(ParameterError, match="leaves seed = 'x'"):
        load("leaves:x", SAMPLING)
