"""Dead pixels are found from the samples, and replaced by the light around."""

import numpy as np

from talbot.models.reconstruct.bad_pixels import dead_pixels, dilated, repaired

SHAPE = 16, 20


def test_dead_columns_are_found_and_darkness_is_none():
    pair = np.full((2, *SHAPE), 0.5)
    pair[:, :, 6] = pair[:, 3, 14] = 0
    dead = dead_pixels(pair)
    assert dead.sum() == 17 and dead[:, 6].all() and dead[3, 14]
    np.testing.assert_allclose(repaired(pair, dead), 0.5)
    half = np.where(np.arange(SHAPE[1]) < 9, 0.0, 0.5) * np.ones((2, *SHAPE))
    assert not dead_pixels(half).any() and not dead_pixels(0 * half).any()
    assert repaired(half, np.zeros(SHAPE, bool)) is half


def test_what_is_beside():
    one = np.zeros(SHAPE, bool)
    one[8, 10] = True
    assert dilated(one, 2).sum() == 25 and dilated(np.stack([one, ~one]), 1)[0].sum() == 9
