"""The classifier in closed form, and the figures of a detection."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.models.recognition import kernel
from talbot.models.recognition.statistics import Spread, roc

RNG = np.random.default_rng(3)


def rings(n):
    """Two classes that no line separates."""
    labels = RNG.integers(0, 2, n)
    angle, radius = RNG.uniform(0, 2 * np.pi, n), 1 + labels + RNG.normal(0, 0.1, n)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1).astype(np.float32), labels


@pytest.mark.parametrize("landmarks", (4000, 60))
def test_it_separates_what_no_line_does_with_all_pictures_or_some(landmarks):
    x, labels = rings(300)
    known = kernel.train(x, labels, 2, landmarks=landmarks)
    assert known.landmarks.shape == (min(landmarks, 300), 2)
    new, truth = rings(400)
    assert (known.classify(new) == truth).mean() > 0.98


def test_equal_landmarks_are_no_error():
    x, labels = np.repeat(rings(8)[0], 10, 0), np.arange(80) % 2
    assert np.isfinite(kernel.train(x, labels, 2, landmarks=40).weights).all()


def test_features_hold_both_signs_and_pool_large_channels():
    x = RNG.standard_normal((2, 6, 6, 3)).astype(np.float32)
    assert np.allclose(np.abs(x).sum(), kernel.features(x).sum(), rtol=1e-5) and kernel.features(x).shape == (2, 216)
    assert kernel.features(np.zeros((2, 20, 20, 3))).shape == (2, 600)
    assert np.array_equal(kernel.features(x[..., :1]), x[..., 0].reshape(2, 36))  # an image stays


def test_roc_of_known_detectors():
    events = np.arange(100) % 2 == 1
    assert roc(events, events).area == 1 and roc(~events, events).area == 0
    assert roc(np.zeros(100), events).area == pytest.approx(0.5)
    scores = RNG.integers(0, 5, 100)
    pairs = np.subtract.outer(scores[events], scores[~events])
    assert roc(scores, events).area == pytest.approx((pairs > 0).mean() + (pairs == 0).mean() / 2)
    with pytest.raises(ParameterError, match="events"):
        roc([1, 2], [True, True])


def test_spread_is_of_a_sample():
    assert Spread.of([1, 3]) == (2, pytest.approx(np.sqrt(2))) and Spread.of([5]) == (5, None)
