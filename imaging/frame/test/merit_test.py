"""Every figure has a baseline that costs nothing, and is marked where it is no better."""

import pytest

from talbot.imaging.frame.figures import summarize_golden
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.merit import IMAGES, against, light_field, sent, table
from talbot.imaging.frame.request import request


def test_an_image_no_better_than_gray_is_said():
    row = {"image_psnr_db": 12.0, "image_psnr_gray_db": 14.0, "image_psnr_jpeg_db": None}
    row |= {"image_psnr_jpegxl_db": 20.0, "image_jpegxl_absent": None}
    assert "no better than gray" in against(row) and "no better" not in against(row | {"image_psnr_db": 15.0})
    assert "no better" not in against(row | {"image_psnr_db": None})


@pytest.mark.parametrize(
    "found,nothing,said", [(-0.5, 0.0, True), (0.0, 0.0, True), (0.5, 0.0, False), (None, 0.0, False)]
)
def test_samples_no_better_than_none_are_said(found, nothing, said):
    line = sent({"snr_db": found, "snr_nothing_sent_db": nothing})
    assert ("no better than nothing sent" in line) == said and line.startswith("SNR ")


@pytest.mark.parametrize("found,said", [(20.0, True), (21.0, True), (21.5, False)])
def test_views_no_better_than_one_copied_are_said(found, said):
    line = light_field({"light_field_psnr_db": found, "light_field_psnr_copied_db": 21.0})
    assert ("no better" in line) == said and "in every view has 21.0 dB" in line


def test_a_frame_of_noise_is_said_to_be_no_better_than_none():
    """Flat gray, and a threshold within the noise."""
    s = summarize_golden(golden_result(request(24, 36, scene="flat:50", threshold=1, noise=4.0)))
    assert "no better than nothing sent: 0.0 dB" in sent(s)
    assert ("SNR of the samples", f"{s['snr_db']:.1f} dB", "no better than nothing sent: 0.0 dB") in table(s)


@pytest.mark.parametrize("mode", ["edge", "image", "raw", "tof"])
def test_every_figure_of_the_mode_is_in_the_table(mode):
    s = summarize_golden(golden_result(request(24, 36, mode=mode, phase=mode == "tof")))
    rows = {what: (found, baseline) for what, found, baseline in table(s)}
    assert all(name in rows["2-D image, SSIM"][1] for end, name in IMAGES.items() if end != "_jpegxl")
    assert rows["2-D image, PSNR"][0] == f"{s['image_psnr_db']:.1f} dB"
    own = {
        "edge": f"{100 * s['edge_precision']:.3g} %" if mode == "edge" else "",
        "image": "",
        "raw": f"{s['light_field_psnr_db']:.1f} dB" if mode == "raw" else "",
        "tof": f"{100 * s['depth_rms_m']:.3g} cm" if mode == "tof" else "",
    }
    names = {
        "edge": "edges among the samples sent (precision)",
        "raw": "light field by linear, PSNR",
        "tof": "depth, RMS error",
    }
    for of, name in names.items():
        assert (name in rows) == (of == mode) and (of != mode or rows[name][0] == own[of])
    assert ("phase, RMS error" in rows) == (mode == "tof")
