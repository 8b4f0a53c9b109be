import sys
from dataclasses import replace

import numpy as np
import pytest

from talbot.imaging.frame.codecs import CODECS, coded
from talbot.imaging.frame.figures import (
    depth_line,
    energy_line,
    exposure_line,
    exposure_of,
    full_line,
    mismatches,
    psnr,
    summarize_golden,
    trims_at_end,
    trims_line,
)
from talbot.imaging.frame.job import expose, flat_field, golden_result, see, simulate_frame, trimmed
from talbot.imaging.frame.merit import against
from talbot.imaging.frame.quality import (
    decoding_error,
    depth_quality,
    ideal_samples,
    image_quality,
    sent_quality,
    snr,
    ssim,
)
from talbot.imaging.frame.request import request
from talbot.models.parameters import CameraParameters, FrameParameters, OpticsParameters, SensorParameters, Window

ONE = Window(0, 0, 0, 0)


def test_mismatches_counts_bytes_that_differ_or_are_missing():
    assert mismatches(b"abc", b"abc") == 0
    assert mismatches(b"abc", b"axc") == 1
    assert mismatches(b"abc", b"axcde") == 3


def test_an_array_smaller_than_a_tile_is_trimmed():
    asked = request(1, 1, scene="flat:50")
    assert trims_at_end(expose(asked, *see(asked)).front_end.trim) == []


DIM = {
    "0.001 lux": ({"lux": 0.001}, {}),
    "0.5 lux, raw, one slot": ({"lux": 0.5, "exposure": 0, "mode": "raw"}, {}),
    "full by dark current": ({}, {"dark_current": 1e-6}),
    "half full by dark current": ({}, {"dark_current": 1e-12}),
    "overexposed": ({"lux": 1e6, "exposure": 0, "timing": {"t_int": 65535}}, {}),
}


@pytest.mark.parametrize("name", DIM)
def test_trims_are_from_a_flat_field_of_its_own_light(name):
    """Whatever the light of the frame, the trims are those of the usual light, to what noise leaves of a step."""
    options, electrical = DIM[name]
    frames = [request(40, 48, scene="coins"), request(40, 48, scene="coins", **options)]
    usual, dim = (replace(f, sensor=replace(f.sensor, electrical=replace(f.sensor.electrical, **part)))
                  for f, part in zip(frames, ({}, electrical), strict=True))  # fmt: skip
    trims = [trimmed(asked).trim for asked in (usual, dim)]
    # Dark current has noise and, through unequal gains, a fixed pattern
    assert np.abs(np.subtract(*trims)).max() <= (12 if "dark current" in name else 2)
    result = golden_result(dim)
    assert summarize_golden(result)["stream_bytes"] == len(result.stream)


def test_the_bench_measures_the_chip_that_takes_the_frame():
    """The same fixed pattern, other noise: the trims follow the gains of the type's pixels."""
    quiet = {"read_noise": 0.0, "offset_fpn": 0.0, "column_fpn": 0.0, "flicker_noise": 0.0, "gain_fpn": 0.1}
    asked = request(4, 6, scene="flat:50")
    asked = replace(asked, sensor=replace(asked.sensor, electrical=replace(asked.sensor.electrical, **quiet)))
    scene, todo = see(asked)
    flat, seen = flat_field(asked), expose(asked, scene, todo)
    assert not np.array_equal(flat, seen.samples[0])
    assert np.corrcoef(flat.ravel(), seen.samples.ravel())[0, 1] > 0.99
    assert seen.front_end.values(seen.samples, "edge").std() < 3  # codes; the spread of the gains alone makes 28


def test_an_image_is_judged_where_it_is_read():
    """Pixels outside of a window change no figure of quality"""
    asked = request(40, 48, mode="image", window=lambda full: Window(1, 3, 1, 4), noise=0.0)
    result = simulate_frame(asked)
    figures = image_quality(result)
    scene = result.exposed.scene
    beside = np.where(result.golden.read, scene.image, 7.0)
    altered = replace(result, exposed=replace(result.exposed, scene=replace(scene, image=beside)))
    assert image_quality(altered) == figures and figures["image_psnr_db"] > figures["image_psnr_gray_db"]


@pytest.mark.parametrize("phase", [False, True])
def test_depth_of_a_scene_before_the_lens(phase):
    """A tilted plane metres away, and its model before the lens: the same light has the same phase noise."""
    errors = {}
    for scale, focus in ((1.0, 3.0), (14.5, 0.207)):
        asked = request(
            40, 48, scene="tilted", mode="tof", phase=phase, camera=CameraParameters(scale=scale, focus=focus)
        )
        errors[scale] = depth_quality(simulate_frame(asked))
    near, far = errors[14.5], errors[1.0]
    assert far["depth_rms_m"] < 0.05 * far["depth_rms_constant_m"]
    assert 0.5 < near["depth_rms_m"] / far["depth_rms_m"] < 2
    assert near["depth_rms_constant_m"] == pytest.approx(far["depth_rms_constant_m"] / 14.5, rel=1e-2)
    assert "no better" not in depth_line(near)
    assert "no better than one depth" in depth_line({"depth_rms_m": 0.2, "depth_rms_constant_m": 0.1})


@pytest.mark.parametrize("seconds,rate", [(0.0225, "30 frames/s"), (0.135, "7.41 frames/s")])
def test_power_is_that_of_frames_there_is_time_for(seconds, rate):
    line = energy_line({"energy_uj": {"total": 100.0, "total_high": 110.0}, "frame_s_at_clock": seconds})
    assert rate in line and f"{100e-3 * min(30, 1 / seconds):.2f} mW" in line


def test_trims_at_an_end_are_said():
    assert trims_at_end([0, 511, 510, -512, -511]) == [1, 3]
    assert "types 1, 3 are at the end" in trims_line({"trims_at_end": [1, 3]})
    assert trims_line({"trims_at_end": []}) == ""


def test_full_wells_count_in_no_figure():
    """Light that fills every well makes a difference of two full wells: no edge, no signal, no image"""
    result = golden_result(request(16, 24, scene="saturated"))
    assert (result.decoded.samples != 0).any() and result.exposed.full.all()  # what trims make of two full wells
    summary = summarize_golden(result)
    names = "snr_db", "psnr_db", "edge_precision", "edge_recall", "image_psnr_db", "image_ssim"
    assert [summary[name] for name in names] == [None] * len(names)
    assert summary["full_pixels"] == summary["pixels"] == 16 * 24 and not result.rebuilt.image.any()
    line = full_line(summary)
    assert "384 of 384 pixels (100 %) have a full well" in line and full_line(summary | {"full_pixels": 0}) == ""


def test_figures_of_a_highlight_are_those_of_the_rest():
    """Whatever a full pixel sends changes no figure"""
    result = golden_result(request(48, 48, scene="specular"))
    full, samples = result.exposed.full, result.decoded.samples.copy()
    assert 0 < full.mean() < 0.5
    samples[full] = 99
    altered = replace(result, decoded=replace(result.decoded, samples=samples))
    assert sent_quality(altered) == sent_quality(result) and image_quality(altered) == image_quality(result)
    samples[~full] = 99
    assert sent_quality(altered) != sent_quality(result)


def test_white_beyond_the_full_well_clips_and_is_said():
    summary = {"frame_s_at_clock": 0.03}
    asked = request(4, 6, scene="flat:50"), request(4, 6, scene="flat:50", lux=1e6, timing={"t_int": 65535})
    dim, bright = (summary | {"exposure": exposure_of(golden_result(frame))} for frame in asked)
    assert "clips" not in exposure_line(dim) and "V = 102 codes" in exposure_line(dim)
    assert bright["exposure"]["white_volts"] == 1.0 and bright["exposure"]["white_codes"] == pytest.approx(127.5)
    assert "times the full well of 100,000 electrons = 1 V = 127 codes, at which it clips" in exposure_line(bright)


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


@pytest.mark.parametrize("scene", ["flat:50", "saturated", "black"])
@pytest.mark.parametrize("mode", ["image", "raw"])
def test_a_scene_without_a_picture_has_no_snr(scene, mode):
    """Samples that are alike but for rounding: their own energy is none."""
    asked = request(24, 36, scene=scene, mode=mode, sensor=SensorParameters(optics=OpticsParameters(m=0.0)))
    figures = sent_quality(golden_result(asked))
    assert figures["snr_db"] is None and figures["snr_nothing_sent_db"] is None


def test_snr_of_sending_nothing_is_zero():
    signal = np.array([3.0, -4.0])
    assert snr(-signal, signal) == pytest.approx(0)
    assert snr(signal / 10, signal) == pytest.approx(20)
    assert snr(0 * signal, signal) is None


@pytest.mark.parametrize("codec", CODECS)
def test_codecs_keep_to_their_bytes_and_gain_with_them(codec):
    y, x = np.mgrid[:96, :96] / 96
    image = 0.5 + 0.4 * np.sin(12 * x * y) * np.cos(9 * y)
    errors = [np.abs(coded(image, codec, size) - image).mean() for size in (800, 6000)]
    assert errors[1] < errors[0] < 0.1
    assert coded(image, codec, 20) is None


def test_a_codec_that_is_not_installed_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "imagecodecs", None)
    figures = image_quality(simulate_frame(request(40, 48, mode="image")))
    assert figures["image_psnr_jpeg_db"] is not None and figures["image_psnr_jpegxl_db"] is None
    assert figures["image_ssim_jpegxl"] is None and "'talbot[codecs]'" in figures["image_jpegxl_absent"]
    assert f"of JPEG XL not compared ({figures['image_jpegxl_absent']})" in against(figures)


def test_ssim_is_one_for_the_truth_whatever_its_mean():
    image = np.random.default_rng(0).random((16, 16))
    assert ssim(image - 3, image) == pytest.approx(1)
    assert ssim(np.zeros((16, 16)), image) < 0.5 and ssim(image[:3], image[:3]) is None
