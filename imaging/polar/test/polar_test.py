"""Polarization of raw frames of the chip's Verilog, and of a light field with Stokes parameters."""

import json
import re

import numpy as np
import pytest

from talbot.commands import main
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.request import request
from talbot.imaging.polar import page
from talbot.imaging.polar.measure import read_polarization


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Folder and summary of a small frame through the Verilog."""
    folder = tmp_path_factory.mktemp("polar")
    assert main(["polar", "--scene=stress", "--rows=40", "--cols=48", f"--out={folder}"]) == 0
    return folder, json.loads((folder / "summary.json").read_text())


def test_psi_of_a_stressed_sheet_has_a_baseline(done):
    _, s = done
    assert s["chip"] and s["stream_mismatches"] == s["decoded_mismatches"] == 0
    assert s["psi_error_deg"] < 5 < s["baselines"]["psi_error_constant_deg"]
    assert s["psi_error_float_deg"] < s["psi_error_deg"]
    assert s["degree_rms"] < 0.5 * s["baselines"]["degree_rms_none"]
    assert s["f1"] is None and s["full_tagged"] == 0


def test_files(done):
    folder, s = done
    assert {path.name for path in folder.iterdir()} == {*page.NAMES}
    with np.load(folder / "polar.npz") as found:
        assert found["psi"].shape == found["confidence"].shape == (40, 48) and np.isfinite(found["psi"]).all()
    assert f"{s['psi_error_deg']:.2f}°" in (folder / "polar.html").read_text()


def test_psi_is_within_the_thesis_at_a_quarter_polarized_and_physical_noise():
    s = read_polarization(golden_result(request(scene="polarized", rows=96, cols=96, mode="raw")), 0.1).summary
    assert s["psi_error_deg"] < 1.12 and s["sure"] > 0.99


@pytest.mark.slow
def test_highlights_are_tagged_and_the_sunlit_card_is_not():
    s = read_polarization(golden_result(request(scene="specular", rows=144, cols=144, mode="raw")), 0.1).summary
    assert s["f1"] > 0.9 > s["baselines"]["f1_bright"]
    assert s["full"] > 500 and s["full_tagged"] == 0
    off = s["disparity"]
    assert off["untagged_rms_px"] < off["found_rms_px"] < off["constant_rms_px"]


def test_an_unpolarized_scene_has_none():
    s = read_polarization(golden_result(request(scene="motorcycle", rows=48, cols=48, mode="raw")), 0.1).summary
    assert s["psi_error_deg"] is None and s["degree_rms"] is None and s["wrongly_polarized"] < 0.005


def test_a_light_field_with_stokes_parameters(tmp_path):
    y, x = np.mgrid[:24, :36] / 36
    light = 0.5 + 0.1 * np.sin(8 * x + np.arange(3)[:, None, None]) * np.ones((3, 3, 24, 36))
    psi = 0.3 + 0.5 * y
    path = tmp_path / "own.npz"
    np.savez(path, light_field=light, s1=0.6 * light * np.cos(2 * psi), s2=0.6 * light * np.sin(2 * psi))
    s = read_polarization(golden_result(request(scene=str(path), rows=24, cols=36, mode="raw")), 0.1).summary
    assert s["views"] == 3 and s["psi_error_deg"] < 2 < s["baselines"]["psi_error_constant_deg"]


def test_stokes_parameters_in_pairs(tmp_path, capsys):
    np.savez(tmp_path / "half.npz", light_field=np.ones((1, 1, 8, 8)), s1=np.zeros((8, 8)))
    assert main(["polar", f"--scene={tmp_path / 'half.npz'}", f"--out={tmp_path / 'out'}"]) == 2
    assert re.search("must hold s1 and s2", capsys.readouterr().err) and not (tmp_path / "out").exists()


def test_a_highlight_out_of_range(capsys, tmp_path):
    assert main(["polar", "--highlight=-1", f"--out={tmp_path / 'out'}"]) == 2
    assert "highlight = '-1'" in capsys.readouterr().err
