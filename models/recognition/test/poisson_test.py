"""Poisson's equation against pictures and against least squares."""

import numpy as np
import pytest

from talbot.models.recognition.poisson import differences, integrate, smooth


@pytest.mark.parametrize("shape", ((8, 8), (7, 12), (3, 2, 9)))
def test_exact_differences_return_the_picture_up_to_a_constant(shape):
    picture = np.random.default_rng(1).random(shape)
    assert np.allclose(integrate(*differences(picture)), picture - picture.mean((-2, -1), keepdims=True))


def test_inexact_differences_return_the_nearest_picture():
    rng = np.random.default_rng(2)
    dx, dy = rng.standard_normal((2, 4, 5))
    dx[:, 0], dy[0], screen = 0, 0, 0.3
    basis = np.eye(20).reshape(20, 4, 5)
    rows = np.concatenate([*differences(basis), np.sqrt(screen) * basis], 1).reshape(20, -1).T
    nearest = np.linalg.lstsq(rows, np.concatenate([dx, dy, np.zeros((4, 5))]).ravel())[0]
    assert np.allclose(integrate(dx, dy, screen).ravel(), nearest)


def test_a_larger_screen_spreads_less():
    point = np.zeros((21, 21))
    point[10, 10] = 1
    far, near = (smooth(point, screen)[10, 10:16] for screen in (0.01, 1.0))
    assert near[5] / near[0] < 0.2 * far[5] / far[0]
