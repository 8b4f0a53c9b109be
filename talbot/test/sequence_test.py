"""Sequences as a user meets them: what the command writes and refuses, what the API gives, a clean end at a signal."""

import json
import random
import signal
import time

import numpy as np
import pytest
from PIL import Image

import talbot
from talbot.base.test.supervise_test import running, started
from talbot.commands import main
from talbot.imaging.sequence.outputs import NAMES
from talbot.models.digital.stream import decode_file
from talbot.test.signals_test import begun

SMALL = ("--rows", "13", "--cols", "50", "--lanes", "4")


def clip(path, count=5, size=(30, 70)):
    wide = np.random.default_rng(2).integers(0, 256, (size[0], size[1] + 2 * count), np.uint8)
    first, *rest = (Image.fromarray(wide[:, 2 * n : 2 * n + size[1]]) for n in range(count))
    first.save(path, save_all=True, append_images=rest, duration=40)
    return str(path)


@pytest.mark.parametrize("mode, its", [("edge", "edges.webp"), ("image", "image.webp"), ("tof", "image.webp")])
def test_what_is_written(tmp_path, mode, its, capsys):
    out = tmp_path / "out"
    words = ["sequence", "--scene", clip(tmp_path / "a.gif"), "--mode", mode, "--threshold", "3", "--out", str(out)]
    assert main([*words, *SMALL]) == 0
    assert "a, " in (said := capsys.readouterr().out) and "5 frames: 0 differ from the model" in said
    names = {path.name for path in out.iterdir()}
    assert names == {"stream.bin", "sensor.toml", "scene.png", "report.html", "summary.json", its} <= set(NAMES)
    summary = json.loads((out / "summary.json").read_text())
    assert summary["frames"] == len(summary["each"]) == 5 and summary["frames_that_differ"] == 0
    assert [frame["frame_number"] for frame in summary["each"]] == list(range(5))
    assert all(frame["stream_mismatches"] == frame["decoded_mismatches"] == 0 for frame in summary["each"])
    frames = decode_file(out / "stream.bin")
    assert [frame.stop - frame.start for frame in frames] == [frame["stream_bytes"] for frame in summary["each"]]
    with Image.open(out / its) as found:
        assert found.n_frames == 5 and found.width >= 384
        found.seek(4)
        found.load()
        assert found.info["timestamp"] + found.info["duration"] == 200
    assert its in (out / "report.html").read_text()


def test_another_mode_takes_its_old_animation_away(tmp_path):
    for mode in ("edge", "image"):
        words = ["--scene", clip(tmp_path / "a.gif"), "--mode", mode, "--out", str(tmp_path / "out")]
        assert main(["sequence", *words, *SMALL]) == 0
    assert not (tmp_path / "out" / "edges.webp").exists() and (tmp_path / "out" / "image.webp").exists()


def hostile(path, kind):
    if kind == "empty":
        path.mkdir()
    elif kind == "one":
        Image.new("L", (9, 9)).save(path)
    elif kind == "broken late":
        path.mkdir()
        for n in range(6):
            Image.fromarray(np.random.default_rng(n).integers(0, 256, (30, 70), np.uint8)).save(path / f"{n}.png")
        (path / "5.png").write_bytes((path / "5.png").read_bytes()[:900])
    return str(path)


@pytest.mark.parametrize(
    "kind, name, said",
    [
        ("empty", "clip", "it is empty"),
        ("one", "clip.gif", "has one frame"),
        ("broken late", "clip", "5.png': the image is damaged"),
        ("none", "clip.gif", "no such file"),
    ],
)
def test_refused_in_one_line_with_nothing_left(tmp_path, kind, name, said, capsys):
    words = ["--scene", hostile(tmp_path / name, kind), "--out", str(tmp_path / "out"), *SMALL]
    assert main(["sequence", *words]) == 2
    err = [line for line in capsys.readouterr().err.splitlines() if not line.startswith(" ")]
    assert len(err) == 1 and said in err[0] and not (tmp_path / "out").exists()


def test_through_the_api(tmp_path):
    sensor = talbot.Sensor(rows=13, cols=50, lanes=4)
    arrays = np.random.default_rng(4).integers(0, 256, (3, 20, 80), np.uint8)
    runs = list(sensor.sequence((frame for frame in arrays), threshold=3, seed=5))
    assert len(runs) == 3
    for number, run in enumerate(runs):
        (frame,) = talbot.decode(run.stream)
        assert frame.header.frame_number == number and (frame.samples == run.samples).all()
        assert run.stream == run.result.golden.stream and run.summary["stream_mismatches"] == 0
    assert runs[0].reconstruct("edges").shape == (24, 4, 9)
    with pytest.raises(talbot.ParameterError, match="depth = 'd.npy': must be left out"):
        sensor.sequence(arrays, depth="d.npy")
    with pytest.raises(talbot.ParameterError, match="did you mean threshold"):
        sensor.sequence(arrays, treshold=3)


@pytest.mark.parametrize("part", range(4))
def test_a_signal_leaves_nothing(tmp_path, part):
    words = ["--scene", clip(tmp_path / "a.gif", 200), "--out", str(tmp_path / "out"), *SMALL]
    child = started(tmp_path, ["-m", "talbot", "sequence", *words])
    begun(child)
    time.sleep((part + random.random()) / 2)
    if child.poll() is None:
        child.send_signal(signal.SIGTERM)
    err = child.communicate(timeout=200)[1]
    assert child.returncode in (0, 143) and "Traceback" not in err
    assert not running(f"TEST_MARK={tmp_path}")
    names = {path.name for path in tmp_path.iterdir()}
    assert names <= {"a.gif", "out"} and (child.returncode == 0) == ("out" in names)
