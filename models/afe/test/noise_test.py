import numpy as np

from talbot.models.afe import KTC_DECISION, NOISE_SCALE, noise_counts


def test_known_words():
    """Worked out from the definition, in Python's unbounded integers."""

    def mix(x):
        for shift, factor in ((16, 0x7FEB352D), (15, 0x846CA68B), (16, 1)):
            x = (x ^ x >> shift) * factor % 2**32
        return x

    for seed, index, decision in ((0, 0, 0), (1, 2, 3), (2**32 - 1, 2**28 - 1, 15), (77, 6_291_455, 9)):
        word = mix(mix(seed) ^ (16 * index + decision))
        assert noise_counts(seed, index, decision) == sum(word.to_bytes(4, "big")) - 510


def test_unit_variance_no_mean_and_a_gaussian_middle():
    n = noise_counts(3, np.arange(200_000), 4) * NOISE_SCALE
    assert abs(n.mean()) < 0.01 and abs(n.std() - 1) < 0.01
    assert abs((np.abs(n) < 1).mean() - 0.683) < 0.02 and abs((np.abs(n) < 2).mean() - 0.954) < 0.01


def test_samples_decisions_and_seeds_are_independent():
    n = noise_counts(3, np.arange(20_000)[:, None], np.arange(KTC_DECISION + 1)).astype(float)
    between_decisions = np.corrcoef(n.T) - np.eye(KTC_DECISION + 1)
    assert np.abs(between_decisions).max() < 0.05
    for lag in (1, 8, 384):
        assert abs(np.corrcoef(n[lag:].ravel(), n[:-lag].ravel())[0, 1]) < 0.02
    other = noise_counts(4, np.arange(20_000)[:, None], np.arange(KTC_DECISION + 1)).astype(float)
    assert abs(np.corrcoef(n.ravel(), other.ravel())[0, 1]) < 0.02


def test_shape_is_the_broadcast_one():
    assert noise_counts(1, 5, 2).shape == ()
    assert noise_counts(1, np.zeros((2, 3), int), 2).shape == (2, 3)
    assert noise_counts(1, np.zeros((2, 1), int), np.arange(4)).shape == (2, 4)
