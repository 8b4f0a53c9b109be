"""A light field from a raw frame of the chip's Verilog, and what the command refuses."""

import json
import re
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from PIL import Image

from talbot.commands import main
from talbot.imaging.frame import light_field
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.light_field import estimate, method_of, pair_of, prior_of, reached
from talbot.imaging.frame.request import request
from talbot.imaging.lightfield import page
from talbot.imaging.lightfield.fields import methods_of, read_back
from talbot.imaging.lightfield.figures import figures, parallax
from talbot.models.capture import CaptureOperator
from talbot.models.parameters import STANDARD, ParameterError, Window
from talbot.models.reconstruct import diode_noise
from talbot.models.reconstruct.bayes import FieldPrior
from talbot.models.reconstruct.methods import METHODS, applicable


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Folder and summary of a small frame through the Verilog."""
    folder = tmp_path_factory.mktemp("lightfield")
    words = ["lightfield", "--scene=tilted", "--rows=40", "--cols=48", "--disparities=7", f"--out={folder}"]
    assert main(words) == 0
    return folder, json.loads((folder / "summary.json").read_text())


def test_every_method_has_baselines(done):
    _, s = done
    free = s["baselines"]["sum_image_psnr_db"]
    assert s["chip"] and s["stream_mismatches"] == s["decoded_mismatches"] == 0
    for m in s["methods"].values():
        assert m["gain_db"] == pytest.approx(m["psnr_db"] - free)
    assert s["methods"]["linear"]["gain_db"] > 3 and s["methods"]["mixture"]["gain_db"] > 6
    assert abs(s["methods"]["direct"]["slope"]) < 0.1 and s["methods"]["linear"]["slope"] > 0.7
    assert s["methods"]["mixture"]["slope"] > 0.9
    assert s["methods"]["linear"]["psnr_db_float"] > s["methods"]["linear"]["psnr_db"]
    assert s["disparity_rms_px"] < 0.5 * s["disparity_rms_constant_px"]
    assert s["depth_rms_m"] < s["depth_rms_constant_m"] < s["range_m"]


def test_files(done):
    folder, s = done
    assert {path.name for path in folder.iterdir()} == {*page.NAMES}
    with np.load(folder / "lightfield.npz") as found:
        assert found["light_field"].shape == (5, 5, 40, 48) and found["disparity"].shape == (40, 48)
    with Image.open(folder / "views.webp") as moving:
        assert moving.n_frames == 16
    text = (folder / "lightfield.html").read_text()
    labels = re.search('data-labels="([^"]*)"', text)
    assert labels and [float(word) for word in labels[1].split("|")] == sorted(map(float, labels[1].split("|")))
    assert len(labels[1].split("|")) == page.FOCUSED**2 and 'aria-label="disparity in focus"' in text
    assert f"{s['methods']['mixture']['psnr_db']:.1f} dB" in text and "direct: no better than the sum image" in text


def test_methods_are_the_fast_ones_and_those_that_are_named(done):
    assert methods_of("") == list(done[1]["methods"]) == ["direct", "linear", "mixture"]
    assert methods_of("sparse") == methods_of("linear, sparse") == ["direct", "linear", "sparse", "mixture"]
    assert methods_of("all") == list(METHODS)


@pytest.mark.slow
def test_all_are_those_that_fit_the_frame():
    result = golden_result(request(scene="tilted", rows=8, cols=12, mode="raw"))  # smaller than a patch of sparse
    prior = FieldPrior(disparities=3)
    assert list(read_back(result, prior, methods=methods_of("all")).found) == applicable(CaptureOperator(result.sensor))
    with pytest.raises(ParameterError, match="method = 'sparse': must be one of direct, linear.* of 8 x 12"):
        read_back(result, prior, methods=methods_of("sparse"))


def test_a_scene_without_parallax_has_no_slope():
    fields = read_back(golden_result(request(scene="flat", rows=8, cols=12, mode="raw")), FieldPrior(disparities=3))
    s = fields.summary
    assert s["methods"]["mixture"]["slope"] is None and s["disparity_rms_px"] is None and s["depth_sure"] == 0
    assert s["methods"]["mixture"]["psnr_db"] > 33


@pytest.mark.parametrize(
    "converter, noise, within",  # one draw of eight lanes' offsets is not their RMS
    [("ideal", 0.0, 0.05), ("ideal", 1.0, 0.05), ("ideal", 3.0, 0.05), ("circuit", 1.0, 0.4)],
)
def test_the_noise_of_a_frame_is_as_its_sensor_has_it(converter, noise, within):
    even = replace(STANDARD, electrical=replace(STANDARD.electrical, column_fpn=0.0))  # nor is that of 48 columns'
    result = golden_result(request(48, 48, sensor=even, mode="raw", noise=noise, converter=converter))
    ideal, asked = pair_of(result, result.exposed.ideal), result.request
    found = np.sqrt(np.mean((pair_of(result, result.decoded.samples) - ideal) ** 2))
    told = np.sqrt(np.mean(diode_noise(ideal, asked.lit, asked.frame.exposing, noise) ** 2))
    assert found == pytest.approx(told, rel=within)
    assert prior_of(result).noise == pytest.approx(max(told, FieldPrior.noise), rel=0.05)


def test_a_part_of_the_array_is_refused():
    with pytest.raises(ParameterError, match="window, types, decimation"):
        read_back(golden_result(request(scene="flat", rows=8, cols=12, mode="raw", mask=0xFF)), FieldPrior())


def test_parallax_of_the_truth_is_one():
    truth = np.random.default_rng(1).random((5, 5, 9, 9))
    assert parallax(truth, truth) == pytest.approx((1, 1))
    assert parallax(np.broadcast_to(truth[2, 2], truth.shape), truth) == (0, 0)
    assert figures(truth, truth, 20.0)["psnr_db"] is None


@pytest.mark.parametrize(
    "word, message",
    [
        ("--far=3", "near = 2.5: must be in \\[3, 20\\], far and more"),
        ("--disparities=0", "disparities = '0': must be an integer in 1..500"),
        ("--scene=nothing", "scene = 'nothing'"),
        ("--method=linear,best", "method = 'best': must be one of all, direct, linear"),
    ],
)
def test_bad_arguments(word, message, capsys, tmp_path):
    assert main(["lightfield", word, f"--out={tmp_path / 'out'}"]) == 2
    err = capsys.readouterr().err
    assert re.search(message, err) and err.count("\n") == 1 and not (tmp_path / "out").exists()


def test_a_folder_tells_its_settings_and_what_it_replaced(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    words = ["lightfield", "--scene=flat", "--rows=8", "--cols=12", "--disparities=3", "--golden"]
    assert main([*words, "--lux=400"]) == 0
    page_of = tmp_path / "build/lightfield/flat-rows=8-cols=12-lux=400-golden-disparities=3/lightfield.html"
    text = page_of.read_text()
    assert "not run" in text and "byte for byte" not in text  # of the chip nothing is known
    for lux in (400, 300):
        assert main([*words, f"--lux={lux}", "--out=same"]) == 0
    assert "replaced there: flat-rows=8-cols=12-lux=400-golden-disparities=3" in capsys.readouterr().out


def test_the_estimate_of_a_part_is_that_of_its_tiles(monkeypatch):
    monkeypatch.setattr(light_field, "prior_of", partial(prior_of, disparities=5))
    asked = partial(request, scene="tilted", rows=24, cols=36, mode="raw", noise=0, converter="ideal")
    window = golden_result(asked(window=lambda full: Window(1, 4, 2, 5), mask=0x7FFFFF))
    box, truth = np.s_[..., 4:20, 12:36], window.exposed.scene.full_light_field
    assert method_of(window) == window.light_field_method == "linear"
    for method in ("linear", "mixture"):
        found = estimate(window, method)
        error = np.sqrt(np.mean((found.light_field - truth * reached(window))[box] ** 2))
        assert error < 0.7 * np.std((window.image - truth)[box]) and np.ptp(found.light_field[box]) > 0.1
        outside = found.light_field.copy()
        outside[box] = 0
        assert not outside.any()
        assert method == "linear" or (np.isinf(found.spread[:4]).all() and (found.spread[box] < 1).any())
    with pytest.raises(ParameterError, match="method = 'sparse': must be one of direct, linear, mixture for a part"):
        estimate(window, "sparse")


def test_a_decimated_frame_has_the_direct_estimate_alone():
    sparse = golden_result(request(scene="tilted", rows=24, cols=36, mode="raw", decimation=1))
    assert sparse.light_field_method == "direct" and sparse.estimate.light_field.any()
    with pytest.raises(ParameterError, match="decimation = 1: must be 0"):
        estimate(sparse, "linear")
    small = golden_result(request(scene="flat", rows=8, cols=12, mode="raw"))
    with pytest.raises(ParameterError, match="'sparse': must be one of direct, linear.* 5 x 5 views of 8 x 12"):
        estimate(small, "sparse")


@pytest.mark.slow
def test_an_estimate_alone_is_that_of_the_page(monkeypatch):
    monkeypatch.setattr(light_field, "prior_of", partial(prior_of, disparities=11))
    result = golden_result(request(scene="tilted", rows=24, cols=24, mode="raw"))
    page = read_back(result, light_field.prior_of(result), methods=METHODS)
    for name, found in page.found.items():
        np.testing.assert_array_equal(estimate(result, name).light_field, found.light_field)
