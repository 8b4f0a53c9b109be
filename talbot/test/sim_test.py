"""The command line as a user meets it: what it writes and what it refuses."""

import json
import resource
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from talbot.base.paths import ROOT
from talbot.commands import main
from talbot.imaging.frame.command import NAME_MAX, name_of
from talbot.imaging.frame.hardware import program
from talbot.imaging.frame.outputs import NAMES
from talbot.imaging.frame.request import request

SMALL = ("--rows", "13", "--cols", "50", "--lanes", "4")
KEYS = {
    "scene",
    "mode",
    "rows",
    "cols",
    "threshold",
    "lanes",
    "seed",
    "pixels",
    "samples",
    "conversions_made",
    "conversions_left_out",
    "cycles",
    "camera",
    "exposure",
    "frame_s_at_clock",
    "stream_bytes",
    "raw_bytes",
    "compression_ratio",
    "stream_mismatches",
    "decoded_mismatches",
    "psnr_db",
    "quadrature_error_codes",
    "hidden_light_codes",
    "full_pixels",
    "trims_at_end",
    "snr_db",
    "snr_nothing_sent_db",
    "edge_precision",
    "edge_recall",
    "image_psnr_db",
    "image_psnr_gray_db",
    "image_psnr_jpeg_db",
    "image_psnr_jpegxl_db",
    "image_jpegxl_absent",
    "energy_uj",
    "left_out",
    "wall_s",
    "rtl_cycles_per_s",
    "tools",
}


@pytest.fixture(scope="module")
def photograph(tmp_path_factory):
    path = tmp_path_factory.mktemp("photograph") / "a photo's name.png"
    Image.fromarray(np.random.default_rng(5).integers(0, 256, (30, 45, 3), np.uint8)).save(path)
    return str(path)


@pytest.fixture(scope="module")
def edges(photograph, tmp_path_factory):
    """The folder of a run in edge mode; not to be changed."""
    out = tmp_path_factory.mktemp("edges") / "out"
    words = "sim", "--scene", photograph, "--threshold", "2", "--out", str(out), *SMALL
    assert main(words) == 0
    return out


@pytest.mark.parametrize(
    "mode, more",
    [
        ("edge", ("--threshold", "3")),
        ("image", ("--types", "low,16")),
        ("raw", ("--window", "1:2,0:4")),
        ("tof", ("--decimation", "1")),
        ("tof", ("--phase",)),
    ],
)
def test_every_mode_on_a_file(photograph, tmp_path, mode, more, capsys):
    out = tmp_path / "out"
    assert main(["sim", "--scene", photograph, "--mode", mode, "--out", str(out), *SMALL, *more]) == 0
    summary = json.loads((out / "summary.json").read_text())
    assert summary.keys() >= KEYS and summary["wall_s"].keys() == {
        "setup",
        "build",
        "capture",
        "rtl",
        "decode",
        "report",
    }
    assert summary["stream_mismatches"] == summary["decoded_mismatches"] == 0 and summary["mode"] == mode
    names = {p.name for p in out.iterdir()}
    assert {"stream.bin", "decoded.npz", "image.png", "conversions.png", "report.html"} <= names <= set(NAMES)
    assert "0 stream bytes and 0 decoded samples differ" in capsys.readouterr().out


def test_the_folder_tells_the_settings(photograph, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["sim", "--scene", photograph, *SMALL, "--mode", "tof", "--phase"]) == 0
    (folder,) = (tmp_path / "build" / "sim").iterdir()
    assert folder.name == "a_photo_s_name-tof-rows=13-cols=50-lanes=4-phase"
    assert "replaced there" not in capsys.readouterr().out


def test_a_run_takes_the_pictures_of_another_mode_away_and_says_what_it_replaced(edges, photograph, tmp_path, capsys):
    out = shutil.copytree(edges, tmp_path / "out")
    words = ["sim", "--scene", photograph, *SMALL, "--mode", "image", "--out", str(out)]
    for said in ("a_photo_s_name-threshold=2-rows=13-cols=50-lanes=4\n", ""):
        assert main(words) == 0
        assert capsys.readouterr().out.partition("  replaced there: ")[2] == said
    assert (edges / "differences.png").exists() and not (out / "differences.png").exists()
    (out / "summary.json").write_text("[]")
    assert main(words) == 0


def test_a_name_that_is_too_long_stays_one(tmp_path):
    names = {name_of({"scene": "s", "types": ",".join(map(str, range(24))) + "," + last * 200}) for last in "01"}
    assert len(names) == 2 and {len(name) for name in names} == {NAME_MAX}


@pytest.mark.slow
def test_waves_of_a_window_of_rows(photograph, tmp_path):
    """A separate simulator, which takes 15 s of processor time to compile."""
    words = "sim", "--scene", photograph, "--threshold", "2", "--waves", "5:6", "--out", str(tmp_path / "out"), *SMALL
    assert main(words) == 0
    lines = (tmp_path / "out" / "waves.vcd").read_text().splitlines()
    row = next(line.split()[3] for line in lines if line.split()[:1] == ["$var"] and line.split()[4] == "row")
    seen = {int(line[1:].split()[0], 2) for line in lines if line[:1] == "b" and line.endswith(f" {row}")}
    assert seen == {5, 6, 7}  # the clock edge that ends the last row is there


def test_a_decoded_file(edges, tmp_path, capsys):
    stream = edges / "stream.bin"
    assert main(["decode", str(stream), "--out", str(tmp_path / "again.npz")]) == 0
    assert "frame 0: edge, 13 x 50, complete" in capsys.readouterr().out
    with np.load(tmp_path / "again.npz") as a, np.load(edges / "decoded.npz") as b:
        assert (a["samples"] == b["samples"]).all()
    damaged = bytearray(stream.read_bytes())
    damaged[200:204] = bytes(4)
    (tmp_path / "damaged.bin").write_bytes(damaged)
    assert main(["decode", str(tmp_path / "damaged.bin")]) == 1
    assert "bad rows: " in capsys.readouterr().out


FILE = "<file>"  # for this one, whose path may have a space


@pytest.mark.parametrize(
    "words, said",
    [
        ("sim --rows abc", "rows = 'abc': must be an integer in 1..1024"),
        ("sim --cols 1537", "cols = '1537': must be an integer in 1..1536"),
        ("sim --lanes 3", "lanes = 3: must be one of 1, 2, 4, 8, 16, 32"),
        ("sim --threshold 128", "threshold = '128': must be an integer in 0..127"),
        ("sim --threshold=-1", "threshold = '-1': must be an integer in 0..127"),
        ("sim --mode video", "mode = 'video': must be one of edge, image, raw, tof"),
        ("sim --lux 0", "lux = '0': must be a number in [0.001, 1000000.0]"),
        ("sim --exposure 1024", "exposure = '1024': must be an integer in 0..1023 or auto"),
        ("sim --scene moving:4000 --mode tof", "scene = moving: must not move in time of flight"),
        ("sim --noise nan", "noise = 'nan': must be a number in [0, 100]"),
        ("sim --focus x", "focus = 'x': must be a number in [0.00796, 1000.0]"),
        ("sim --f-number nan", "f_number = nan: must be a number in [0.5, 32]"),
        ("sim --scale 1e999", "scale = inf: must be a number in [0.001, 10000.0]"),
        ("sim --pupil=", "exit_pupil = '': must be a number in [0.001224"),
        ("sim --rows= --waves 1", "rows = '': must be an integer in 1..1024"),
        ("cameras --size=", "size = '': must be an integer in 60..360"),
        ("calibrate --rows=", "rows = '': must be an integer in 1..1024"),
        ("sim --waves=", "waves = '': must be an integer in 0..383"),
        ("pixel --wavelength-um=", "wavelength_um = '': must be a number in [0.35, 1]"),
        ("verilog --rows nan", "rows = 'nan': must be an integer in 1..1024"),
        ("mutate --seed x", "seed = 'x': must be an integer in 0..4294967295"),
        ("mutate --factor 1e999", "factor = inf: must be a number in [0.001, 100]"),
        ("layout amp_ctrl --utilization nan", "utilization = nan: must be a number in "),
        ("sim --lux 1_0", "lux = '1_0': must be a number in [0.001, 1000000.0]"),
        ("sim --seed \u0663", "seed = '\u0663': must be an integer in 0..4294967295"),
        ("sim --mode \x1b[31m", r"mode = '\x1b[31m': must be one of "),
        ("sim --f-number 0.4", "f_number = 0.4: must be a number in [0.5, 32]"),
        ("sim --focus 0.005", "focus = 0.005: must be a number in [0.00796, 1000.0]"),
        ("sim --pupil 0.001", "exit_pupil = 0.001: must be a number in [0.001224"),
        ("sim --pupil 0.0013", "exit_pupil = 0.0013: must be a number in [0.00155"),
        ("sim --focal 0.001", "focal_length = 0.001: must be a number in [0.00155"),
        ("sim --focal 0.006", "focal_length (of the scene motorcycle) = 0.006: must be a number in [0.00764"),
        ("sim --rows 1024 --cols 1024", "(of the scene motorcycle) = 0.00796: must be a number in [0.0203"),
        ("sim --seed 1.5", "seed = '1.5': must be an integer in 0..4294967295"),
        ("sim --window 0:96,0:3", "window rows = '96': must be an integer in 0..95"),
        ("sim --types 24", "types = '24': must be an integer in 0..23"),
        ("sim --decimation 4", "decimation = '4': must be an integer in 0..3"),
        ("sim --waves 380:384", "waves = '384': must be an integer in 0..383"),
        ("sim --phase", "phase = True: needs mode 'tof'"),
        ("sim --scene nowhere.png", "scene = 'nowhere.png': no such file"),
        ("sim --scene nothing", "scene = 'nothing': must be an image file or one of motorcycle"),
        ("sim --scene edge:x", "scene edge degrees = 'x': must be a number in [-360, 360]"),
        (f"sim --scene {FILE}", "must be an image file of a form that is read"),
        ("sim --depth d.npy", "depth = 'd.npy': must be left out"),
        (f"sim --out {FILE}", "must be a folder"),
        ("cells --workers 0", "--workers: '0': must be 1 or more, or -1"),
        ("sensor --out /proc/sensor.toml", "out = '/proc': must be a folder that you may write"),
        *((f"{name} --out {FILE}", "must be a folder") for name in ("layout", "cells", "coverage")),
        (f"stability --out {FILE}", "must be a folder"),
        ("stability --json /tmp", "json = '/tmp': must be a file, not a folder"),
        ("sim --nothing", "unrecognized arguments: --nothing"),
        ("sim --scnee coins", "unrecognized arguments: --scnee coins; did you mean --scene?"),
        ("simm", "invalid choice: 'simm'; did you mean sim?"),
        ("sim --sce coins", "unrecognized arguments: --sce coins"),
        ("sim --scene /tmp", "scene = '/tmp': must be an image file, not a folder"),
        (f"sim --scene {FILE}", "of a form that is read, PNG, JPEG, TIFF, "),
        ("sim --window -1:3,0:2", "window rows = '-1': must be an integer in 0..95"),
        ("sim --focus -1e9", "focus = -1000000000.0: must be a number in [0.00796, 1000.0]"),
        (f"sim --scene {'x' * 5000}", "x...: File name too long" if sys.version_info < (3, 14) else "x...': must be "),
        (f"sim --rows={'7,' * 2500}", "...': must be an integer in 1..1024"),
        (f"sim --{'x' * 5000}", "..."),
        ("draw", "invalid choice: 'draw'"),
        *((f"{name} --document {FILE}", "must have the comments") for name in ("sizes", "openroad-compare")),
        ("stuck-at --sample=-1", "sample = -1: must be an integer in 0..1000000000"),
        ("decode nowhere.bin", "file = nowhere.bin: No such file"),
        ("decode /dev/zero --out build/zero.npz", "file = /dev/zero: must be a file, not a device"),
        (f"decode {FILE}", "a frame starts with b'TLBT'"),
        ("tradeoff --only speed", "only = 'speed': must be one of divider"),
        ("sim --rows 9 --cols 9 --window 3:3,0:0", "window rows = '3': must be an integer in 0..2"),
    ],
)
def test_refused_in_one_line(words, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    try:
        status = main([word.replace(FILE, __file__) for word in words.split()])
    except SystemExit as stop:
        status = stop.code
    out, err = capsys.readouterr()
    assert status == 2 and said in err and err.count("\n") == 1 and err.startswith("talbot: error: ")
    assert len(err) < 700
    assert not out and not list(tmp_path.iterdir())


def test_no_room_for_the_results(photograph, tmp_path):
    """A limit on the size of files acts as a full disk: writing fails half-way through."""
    program(request(rows=13, cols=50, lanes=4).sensor)  # compiled without the limit

    def small_files():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))

    result = subprocess.run(
        [sys.executable, "-m", "talbot", "sim", "--scene", photograph, *SMALL, "--out", str(tmp_path / "out")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        preexec_fn=small_files,
    )
    assert result.returncode == 2 and "File too large" in result.stderr
    assert result.stderr.splitlines()[-1].startswith("talbot: error: file = ")
    assert not (tmp_path / "out").exists()


def test_no_folder_for_temporary_files():
    """As where every disk is full: no file may have a byte."""

    def no_files():
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))

    words = [sys.executable, "-m", "talbot", "sim"]
    result = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, preexec_fn=no_files)
    assert result.returncode == 2 and not result.stdout
    (line,) = result.stderr.splitlines()
    assert line.startswith("talbot: error: file = temporary: No usable temporary directory found in ['/tmp', ")
