"""Views moved and added: a slanted textured plane, grids that are not square, disparity, all in focus."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, map_coordinates, shift

from talbot.models.reconstruct.refocus import all_in_focus, disparity_of, moved, refocus

SHAPE = 33, 46
NOISE = gaussian_filter(np.random.default_rng(3).random((90, 110)), 1)
TEXTURE = (NOISE - NOISE.min()) / np.ptp(NOISE)
TILT = 2 / SHAPE[1]  # of the disparity, px per view step and px: from -1 to 1
TRIED = np.linspace(-2.5, 2.5, 21)


def slanted(rows, cols):
    """Light field of rows x cols views of a textured plane whose disparity grows to the right, and that disparity."""
    y, x = np.indices(SHAPE, float)
    field = np.empty((rows, cols, *SHAPE))
    for v, u in np.ndindex(rows, cols):
        dv, du = v - (rows - 1) / 2, u - (cols - 1) / 2
        across = (x - du) / (1 - du * TILT)  # x + du (TILT across - 1) = across
        field[v, u] = map_coordinates(TEXTURE, (y + dv * (TILT * across - 1) + 25, across + 30), order=1)
    return field, TILT * x - 1


@pytest.mark.parametrize("grid", [(5, 5), (3, 5), (1, 7), (4, 4), (9, 1)])
def test_a_slanted_plane(grid):
    field, truth = slanted(*grid)
    found, spread = disparity_of(field, TRIED)
    sure = spread < 0.5
    assert sure.mean() > 0.9 and np.sqrt(np.mean((found - truth)[sure] ** 2)) < 0.2 * truth.std()
    middle = slanted(1, 1)[0][0, 0]
    sharp = np.std(all_in_focus(field, found) - middle)
    assert sharp < 0.7 * min(np.std(refocus(field, d) - middle) for d in TRIED)
    columns = [slice(0, 9), slice(37, 46)]  # far and near
    for d, (own, other) in zip((-0.85, 0.85), (columns, columns[::-1]), strict=True):
        error = np.abs(refocus(field, d) - middle)
        assert error[:, own].mean() < error[:, other].mean() / 2


def test_uniform_light_tells_nothing():
    for field in (np.full((5, 5, 9, 12), 0.3), np.zeros((5, 5, 9, 12))):
        assert np.isinf(disparity_of(field, TRIED)[1]).all()
        np.testing.assert_allclose(refocus(field, 1.3), field[0, 0], rtol=1e-12)


def test_views_without_light_do_not_count():
    field, _ = slanted(3, 3)
    dark = field.copy()
    dark[0, 0] = dark[2, 2] = 0
    np.testing.assert_allclose(refocus(dark, 0), field.reshape(9, *SHAPE)[1:8].mean(0))


@pytest.mark.parametrize("move", [(0, 0), (0.25, -1.75), (-40, 3), (2.5, 50)])
def test_a_picture_moves_as_scipy_moves_it(move):
    image = TEXTURE[:33, :46].astype(np.float32)
    out = moved(image, *move)
    np.testing.assert_allclose(out, shift(image, move, order=1, mode="nearest"), atol=1e-6)
    assert out.dtype == np.float32
