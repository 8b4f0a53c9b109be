import numpy as np
import pytest

from flow.frame.figures import decoding_error, ideal_samples, mismatches, psnr
from models.parameters import FrameParameters, Window

ONE = Window(0, 0, 0, 0)


def test_mismatches_counts_bytes_that_differ_or_are_missing():
    assert mismatches(b"abc", b"abc") == 0
    assert mismatches(b"abc", b"axc") == 1
    assert mismatches(b"abc", b"axcde") == 3


def test_psnr():
    assert psnr(np.zeros(4)) is None
    assert psnr(np.full(4, 255.0)) == pytest.approx(0)
    assert psnr(np.full(4, 25.5)) == pytest.approx(20)


def test_a_phase_error_goes_the_short_way_round():
    frame = FrameParameters(ONE, mode="tof", phase=True)
    ideal = np.array([[[100.0, 50, 0, 51], [100, 50, 0, 50]]])  # phases just over 0, and 0
    sent = np.array([[[255, 100], [77, 0]]])  # just under a turn; not valid
    error = decoding_error(sent, ideal, np.ones((1, 2), bool), frame)
    assert -2 < error[0, 0] < -1
    assert error[1, 0] == 0


def test_ideal_phase_has_both_signs():
    frame = FrameParameters(ONE, mode="tof", phase=True)
    taps = np.array([[[0.0, 50, 100, 50], [50, 100, 50, 0]]])  # half a turn; three quarters
    assert ideal_samples(taps, frame)[0, :, 0] == pytest.approx([128, 192])
