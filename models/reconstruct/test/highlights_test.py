"""Disparity without highlights: what is around fills them, and nothing else changes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from talbot.models.parameters import ParameterError
from talbot.models.reconstruct.highlights import without_highlights


def _slope(rows=24, cols=30):
    y, x = np.mgrid[:rows, :cols]
    return 0.02 * x - 0.01 * y


def test_a_mirror_image_in_a_slanted_surface_takes_the_surface_around_it():
    truth, tags = _slope(), np.zeros((24, 30), bool)
    tags[8:13, 10:16] = True
    found = np.where(tags, 1.8, truth)
    filled, spread = without_highlights(found, np.full(truth.shape, 0.1), tags)
    assert np.abs(filled - truth).max() < 0.02 and (spread < 0.5).all()
    np.testing.assert_array_equal(filled[~tags], truth[~tags])


def test_what_is_not_sure_does_not_count():
    truth, tags = _slope(), np.zeros((24, 30), bool)
    tags[10, 12] = True
    wild = np.where(np.indices(truth.shape)[1] > 12, 5.0, truth)
    filled, _ = without_highlights(wild, np.where(wild > 1, np.inf, 0.1), tags)
    assert abs(filled[10, 12] - truth[10, 12]) < 0.1


def test_a_highlight_without_a_sure_neighbour_is_not_known():
    filled, spread = without_highlights(np.ones((6, 7)), np.zeros((6, 7)), np.ones((6, 7), bool))
    assert (filled == 1).all() and np.isinf(spread).all()


@given(
    arrays(float, (5, 6), elements=st.floats(-3, 3)),
    arrays(float, (5, 6), elements=st.floats(0, 1) | st.just(np.inf)),
    arrays(bool, (5, 6)),
)
def test_the_disparity_is_finite_and_within_what_is_around(disparity, spread, tags):
    filled, doubt = without_highlights(disparity, spread, tags)
    assert np.isfinite(filled).all() and not np.isnan(doubt).any()
    assert disparity.min() - 1e-6 <= filled.min() and filled.max() <= disparity.max() + 1e-6


def test_bad_arguments():
    with pytest.raises(ParameterError, match="tags shape"):
        without_highlights(np.ones((2, 3)), np.ones((2, 3)), np.ones((3, 2), bool))
    with pytest.raises(ParameterError, match="sure = 0"):
        without_highlights(np.ones((2, 3)), np.ones((2, 3)), np.ones((2, 3), bool), 0)
