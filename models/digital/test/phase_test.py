import numpy as np
import pytest

from talbot.models.digital.phase import phase_samples
from talbot.models.parameters import ChipParameters

CHIPS = [ChipParameters(), ChipParameters(divider="cordic")]


@pytest.mark.parametrize("chip", CHIPS, ids=lambda c: c.divider)
def test_recovers_the_phase_of_four_taps(chip):
    """i(tau) = 128 + 100 cos(2 pi f tau + phase), Eq. 5.2 and 5.3: within the quantization of the taps."""
    phase = np.arange(0, 2 * np.pi, 0.01)
    tap = np.array([0, np.pi / 2, np.pi, 3 * np.pi / 2])
    taps = np.rint(128 + 100 * np.cos(tap + phase[:, None])).astype(int)
    got, amplitude = phase_samples(taps, chip)
    error = (got - phase * 128 / np.pi + 128) % 256 - 128
    assert np.abs(error).max() < 1.0
    assert (amplitude == np.abs(np.stack([taps[:, 0] - taps[:, 2], taps[:, 3] - taps[:, 1]])).max(axis=0)).all()


@pytest.mark.parametrize("chip", CHIPS, ids=lambda c: c.divider)
def test_noise_floor_and_no_signal(chip):
    taps = [[40, 0, 0, 0], [39, 0, 0, 0], [7, 7, 7, 7]]
    assert phase_samples(taps, chip, 40)[1].tolist() == [40, 0, 0]
    assert phase_samples(taps, chip)[1].tolist() == [40, 39, 0]
