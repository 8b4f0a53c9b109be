"""Depth by time of flight through the chip's Verilog: unwrapped, past an occluder, and what is refused."""

import json
import re
from argparse import ArgumentParser
from dataclasses import replace

import numpy as np
import pytest

from talbot.commands import main
from talbot.imaging.depth import command, page
from talbot.models.parameters import STANDARD
from talbot.models.pixel.time_of_flight import SPEED_OF_LIGHT


def measured(folder, *words):
    """Summary of a small run."""
    assert main(["depth", "--disparities=11", f"--out={folder}", *words]) == 0
    return json.loads((folder / "summary.json").read_text())


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Folder and summary of a tilted plane through the Verilog."""
    folder = tmp_path_factory.mktemp("depth")
    return folder, measured(folder, "--scene=tilted", "--rows=13", "--cols=50", "--lanes=4")


def test_depth_has_baselines(done):
    _, s = done
    assert s["chip"] and s["stream_mismatches"] == s["decoded_mismatches"] == 0
    assert s["ambiguity_m"] < s["range_m"]
    free, best = s["baselines"], s["methods"]["field"]
    assert s["depth_rms_m"] == best["rms_m"] < 0.02 * s["range_m"]
    assert best["rms_m"] < 0.2 * min(free[name]["rms_m"] for name in ("constant", "light_field", "wrapped"))
    assert best["wrong_turns"] == 0 and best["sure"] > 0.8


def test_the_divider_costs_what_its_codes_are_worth(done):
    _, s = done
    code, m = s["ambiguity_m"] / 256, s["methods"]
    assert m["sums"]["rms_m"] < m["divider"]["rms_m"] < m["sums"]["rms_m"] + code
    assert m["field_divider"]["rms_m"] < m["field"]["rms_m"] + code


def test_files(done):
    folder, s = done
    assert {path.name for path in folder.iterdir()} == {*page.NAMES}
    with np.load(folder / "depth.npz") as found:
        assert found["taps"].shape == (4, 5, 5, 13, 50) and np.isfinite(found["depth"]).all()
    text = (folder / "depth.html").read_text()
    assert f"{s['depth_rms_m']:.4f} m" in text and "Past the occluder" not in text


def test_a_chip_without_phase_path_has_no_method_of_its_divider(tmp_path):
    (tmp_path / "plain.toml").write_text('chip.divider = "none"\n', encoding="utf-8")
    words = f"--sensor={tmp_path / 'plain.toml'}", "--scene=tilted", "--rows=13", "--cols=24", "--golden"
    s = measured(tmp_path / "out", *words)
    assert s["depth_method"] == "field" and not {"divider", "field_divider"} & set(s["methods"])
    assert "the chip's divider" not in (tmp_path / "out" / "depth.html").read_text()


@pytest.mark.slow
def test_depth_edges_have_their_own_turns(tmp_path):
    s = measured(tmp_path, "--scene=cornell", "--rows=96", "--cols=96", "--golden")
    best, free = s["methods"]["field"], s["baselines"]["light_field"]
    assert best["rms_all_m"] < 0.012 * s["range_m"] < 0.1 * free["rms_all_m"] and best["sure"] > 0.8


@pytest.mark.slow
def test_behind_leaves_the_rim_of_a_ball_has_no_depth(tmp_path):
    past = measured(tmp_path, "--scene=plant", "--f-mod=25e6", "--golden")["behind"]
    assert past["occluded"] == pytest.approx(0.5, abs=0.05) and past["seen"] > 0.55
    assert past["rms_m"] < 0.03 * past["range_m"] < past["rms_constant_m"] < past["rms_all_rays_m"]


@pytest.mark.slow
def test_a_wall_behind_a_fence(tmp_path):
    s = measured(tmp_path, "--scene=fence", "--rows=24", "--cols=48", "--f-mod=25e6", "--golden")
    past = s["behind"]
    assert past["occluded"] == pytest.approx(0.5, abs=0.05) and past["seen"] > 0.9
    assert past["rms_m"] < 0.03 * past["range_m"] < past["rms_constant_m"] < past["rms_all_rays_m"]


@pytest.mark.parametrize("scene", ["black", "saturated"])
def test_no_light_and_too_much_have_no_depth(scene, tmp_path):
    s = measured(tmp_path, f"--scene={scene}", "--rows=8", "--cols=12", "--golden")
    assert s["depth_sure"] == 0 and s["depth_rms_m"] is None


@pytest.mark.slow
def test_a_depth_beyond_the_disparities_that_are_tried_is_not_sure(tmp_path):
    words = "--scene=tilted", "--rows=40", "--cols=48", "--golden", "--far=1.8", "--near=2.5"
    assert measured(tmp_path, *words)["depth_sure"] < 0.1


@pytest.mark.parametrize(
    "word, message",
    [
        ("--f-mod=1", "f_mod = '1': must be a number in \\[100000.0, 1000000000.0\\]"),
        ("--contrast=2", "contrast = '2'"),
        ("--ambient=-1", "ambient = '-1'"),
        ("--far=13", "near = 2.5: must be in \\[13, 20\\]"),
    ],
)
def test_bad_arguments(word, message, capsys, tmp_path):
    assert main(["depth", word, "--rows=8", "--cols=12", f"--out={tmp_path / 'out'}"]) == 2
    assert re.search(message, capsys.readouterr().err) and not (tmp_path / "out").exists()


def test_a_scene_without_depth(capsys, tmp_path):
    np.save(tmp_path / "own.npy", np.full((3, 3, 8, 12), 0.5))
    assert main(["depth", f"--scene={tmp_path / 'own.npy'}", "--rows=8", "--cols=12", f"--out={tmp_path / 'out'}"]) == 2
    assert "must have a depth" in capsys.readouterr().err


def test_a_light_field_with_a_depth_of_its_own(tmp_path):
    x = np.arange(36.0)
    disparity = np.broadcast_to(np.linspace(-0.6, 0.6, 36), (24, 36))
    steps = np.arange(5) - 2
    field = np.array(
        [[0.5 + 0.3 * np.sin((x + u * disparity) * 0.7 + np.arange(24)[:, None]) for u in steps] for _ in steps]
    )
    depth = 1 / (1 / 3 + disparity / 10.4)
    np.savez(tmp_path / "own.npz", light_field=field, disparity=disparity, depth=depth)
    words = f"--scene={tmp_path / 'own.npz'}", "--rows=24", "--cols=36", "--golden", "--f-mod=5e7"
    s = measured(tmp_path / "out", *words)
    assert s["range_m"] == pytest.approx(np.ptp(depth)) and s["depth_rms_m"] < 0.1 < s["baselines"]["constant"]["rms_m"]


def test_what_the_capture_does_not_ask_is_refused(capsys, tmp_path):
    with pytest.raises(SystemExit, match="2"):
        main(["depth", "--views=3", f"--out={tmp_path / 'out'}"])
    assert "unrecognized arguments: --views=3" in capsys.readouterr().err and not (tmp_path / "out").exists()


@pytest.mark.slow
def test_light_by_other_ways_moves_the_depth_of_a_room(tmp_path):
    s = measured(tmp_path / "all", "--scene=room", "--rows=48", "--cols=48", "--golden")
    assert 0.03 < s["multipath"]["median_m"] < 0.3 and s["multipath"]["rms_m"] < 0.3
    straight = measured(tmp_path / "direct", "--scene=room", "--rows=48", "--cols=48", "--golden", "--direct")
    assert straight["multipath"] is None


def test_coded_light_sees_past_the_fog(tmp_path, capsys):
    words = "--scene=fog", "--rows=13", "--cols=50", "--lanes=4", "--code=31"  # as `done`
    s = measured(tmp_path, *words)
    assert s["chip"] and s["stream_mismatches"] == s["decoded_mismatches"] == 0
    code, sine, free = s["methods"]["code"], s["methods"]["sums"], s["baselines"]["constant"]
    assert code["sure"] > 0.6 and code["rms_m"] < 0.3 * min(sine["rms_m"], free["rms_m"])
    # What was asked for leads: summary, first printed line, first tile, arrays
    assert s["depth_method"] == "code" and s["depth_rms_m"] == code["rms_m"] and s["depth_sure"] == code["sure"]
    lead = f"{code['rms_m']:.4f} m"
    assert capsys.readouterr().out.splitlines()[1].startswith(f"  coded light, sums: {lead} RMS in ")
    assert f'<div class="tiles">\n<div class="tile "><b>{lead}</b>coded light' in (tmp_path / "depth.html").read_text()
    with np.load(tmp_path / "depth.npz") as arrays:
        assert arrays["confidence"].mean() == pytest.approx(code["sure"])


def test_a_rendered_scene_through_another_lens_has_no_depth(capsys, tmp_path):
    assert main(["depth", "--scene=room", "--focus=2", f"--out={tmp_path / 'out'}"]) == 2
    assert "a rendered scene has one at its own size and lens" in capsys.readouterr().err


@pytest.mark.parametrize(
    "file, words, fields",
    [
        ({}, [], (0, 250e6, 4.0)),
        ({}, ["--code=31"], (31, 250e6, 4.0)),
        ({"code": 63, "chip_rate": 1e8, "code_delay": 0.0}, [], (63, 1e8, 0.0)),
        ({"code": 63, "chip_rate": 1e8}, ["--code=0", "--gate=3"], (0, 1e8, 6.0)),
    ],
)
def test_a_code_is_of_the_options_else_of_the_sensor_file(file, words, fields):
    parser = ArgumentParser()
    command.add_arguments(parser)
    code = command._code(parser.parse_args(words), replace(STANDARD.electrical, **file))
    chips, rate, meters = fields
    assert (code["code"], code["chip_rate"]) == (chips, rate)
    assert code["code_delay"] == pytest.approx(meters / SPEED_OF_LIGHT)


def test_three_taps_where_nothing_moves(done):
    _, s = done
    four, three = s["methods"]["field"], s["methods"]["three"]
    assert s["left_out"]["taps"] == 1 and three["rms_m"] < 1.5 * four["rms_m"]
