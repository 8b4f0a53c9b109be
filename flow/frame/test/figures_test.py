import numpy as np
import pytest

from flow.frame.figures import mismatches, psnr, trims_at_end, trims_line
from flow.frame.job import expose, see
from flow.frame.quality import coded, decoding_error, ideal_samples, snr, ssim
from flow.frame.request import request
from models.parameters import FrameParameters, Window

ONE = Window(0, 0, 0, 0)


def test_mismatches_counts_bytes_that_differ_or_are_missing():
    assert mismatches(b"abc", b"abc") == 0
    assert mismatches(b"abc", b"axc") == 1
    assert mismatches(b"abc", b"axcde") == 3


def test_an_array_smaller_than_a_tile_is_trimmed():
    asked = request(1, 1, scene="flat:50")
    assert trims_at_end(expose(asked, *see(asked)).front_end.trim) == []


def test_trims_at_an_end_are_said():
    assert trims_at_end([0, 511, 510, -512, -511]) == [1, 3]
    assert "types 1, 3 are at the end" in trims_line({"trims_at_end": [1, 3]})
    assert trims_line({"trims_at_end": []}) == ""


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


def test_snr_of_sending_nothing_is_zero():
    signal = np.array([3.0, -4.0])
    assert snr(-signal, signal) == pytest.approx(0)
    assert snr(signal / 10, signal) == pytest.approx(20)
    assert snr(0 * signal, signal) is None


@pytest.mark.parametrize("codec", ["jpeg", "avif"])
def test_codecs_keep_to_their_bytes_and_gain_with_them(codec):
    y, x = np.mgrid[:96, :96] / 96
    image = 0.5 + 0.4 * np.sin(12 * x * y) * np.cos(9 * y)
    errors = [np.abs(coded(image, codec, size) - image).mean() for size in (800, 6000)]
    assert errors[1] < errors[0] < 0.1
    assert coded(image, codec, 20) is None


def test_ssim_is_one_for_the_truth_whatever_its_mean():
    image = np.random.default_rng(0).random((16, 16))
    assert ssim(image - 3, image) == pytest.approx(1)
    assert ssim(np.zeros((16, 16)), image) < 0.5 and ssim(image[:3], image[:3]) is None
