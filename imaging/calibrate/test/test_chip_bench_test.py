"""The command from a simulated bench to a sensor, and from its own CSV file to the same sensor."""

import json
from argparse import Namespace

import numpy as np
import pytest

from talbot.base.command import main
from talbot.imaging.bench.job import expected
from talbot.imaging.bench.page import NAMES
from talbot.imaging.bench.readings import HEAD
from talbot.imaging.bench.simulated import OPENING_UM
from talbot.imaging.calibrate import command
from talbot.imaging.frame.sensor import asked_sensor
from talbot.models.parameters import STANDARD, ParameterError, read_sensor
from talbot.models.pixel import optical_gains


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("bench") / "first"
    assert main(command, ["--bench", "simulated", "--holes=7", "--seed=5", f"--out={out}"]) == 0
    return out


def test_files(folder):
    assert {path.name for path in folder.iterdir()} == {*NAMES}
    s = json.loads((folder / "summary.json").read_text())
    assert s["response_rms"] < 0.04 and s["arguments"]["bench"] == ["simulated"]
    page = (folder / "bench.html").read_text()
    assert page.count("<svg") == 24 and "Type 23, 24/-45/90: beta" in page


def test_a_sensor_that_other_commands_read(folder):
    options = Namespace(sensor=str(folder / "sensor.toml"), pixel=str(folder / "response.npz"))
    sensor = asked_sensor(options)
    plain = read_sensor(folder / "sensor.toml")
    for kind, nominal in zip(plain.tile.types, STANDARD.tile.types, strict=True):
        assert kind.beta == pytest.approx(nominal.beta, abs=0.15) and kind.m == pytest.approx(0.7, abs=0.03)
    assert plain.electrical.dark_current == pytest.approx(1.85e-16, rel=0.1)
    gains = [optical_gains(each.tile, each.optics) for each in (sensor, STANDARD)]
    np.testing.assert_allclose(*gains, atol=0.03)


@pytest.mark.slow
def test_the_simulated_file_is_a_file_like_any_other(folder, tmp_path):
    words = f"--bench {folder / 'measurements.csv'} --out {tmp_path / 'second'}".split()
    assert main(command, [*words]) == 0
    first, second = (json.loads((path / "summary.json").read_text()) for path in (folder, tmp_path / "second"))
    assert "truth" not in second and not (tmp_path / "second" / "measurements.csv").exists()
    for a, b in zip(first["types"], second["types"], strict=True):
        assert a["beta"] == pytest.approx(b["beta"], abs=0.01) and a["m"] == pytest.approx(b["m"], abs=1e-3)


@pytest.mark.parametrize(
    "words, said",
    [
        ("--bench none.csv", "bench = 'none.csv': must be simulated, or a CSV file of readings"),
        ("--bench simulated --views 5", "views = '5': must be left out with bench = simulated"),
        ("--bench m.csv --noise 0", "noise = '0': must be left out with bench = a file"),
        ("--bench simulated --scene coins", "scene = 'coins': must be left out with bench"),
        ("--bench simulated --pixel gf180", "pixel = 'gf180': must be one of ideal, sky130"),
        ("--document README.md", "document = 'README.md': must be left out without bench = simulated"),
        ("--bench simulated --holes 4", "holes = '4': must be an integer in 5..31"),
    ],
)
def test_refused(words, said, capsys, tmp_path):
    assert main(command, [*words.split(), f"--out={tmp_path / 'out'}"]) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1 and not (tmp_path / "out").exists()


def test_a_wrong_line_is_refused_and_nothing_written(tmp_path, capsys):
    path = tmp_path / "m.csv"
    path.write_text(f"{','.join(HEAD)}\ndark,9,1,,,,25,2,3,1.9,1.9,1.8,1.8\n")
    assert main(command, ["--bench", str(path), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert "row = '9' (line 2" in error and error.count("\n") == 1 and not (tmp_path / "out").exists()


def test_another_tile_than_the_chips_is_refused(tmp_path, capsys):
    (tmp_path / "small.toml").write_text("tile.rows = 2\ntile.cols = 2\n")
    words = ["--bench", "simulated", f"--sensor={tmp_path / 'small.toml'}", f"--out={tmp_path / 'out'}"]
    assert main(command, words) == 2
    assert "tile = 2 x 2: must be the standard's 4 x 6 in its order" in capsys.readouterr().err


def test_expected_readings_follow_the_light():
    rows = [line.split("|") for line in expected(STANDARD, 500.0, 9).splitlines()[2:]]
    twice = [line.split("|") for line in expected(STANDARD, 1000.0, 9).splitlines()[2:]]
    assert [row[1].strip() for row in rows] == ["plain", "beta 12", "beta 18", "beta 24", "covered"]
    ratios = [float(b[2].split("..")[1]) / float(a[2].split("..")[1]) for a, b in zip(rows, twice, strict=True)]
    np.testing.assert_allclose(ratios, 2, rtol=0.02)


@pytest.mark.needs("layout")
def test_the_opening_is_the_drawn_one():
    from talbot.models.parameters import TileParameters
    from talbot.pixels.layout.pixel import OPENING
    from talbot.pixels.layout.write import drawn_pixels

    left, right, bottom, top = drawn_pixels("sky130", TileParameters.small(1, 1))[0].within(OPENING)
    assert pytest.approx((right - left, top - bottom)) == OPENING_UM


def test_a_response_that_is_none(tmp_path):
    np.savez(tmp_path / "response.npz", angles=[0.0])
    options = Namespace(sensor=None, pixel=str(tmp_path / "response.npz"))
    with pytest.raises(ParameterError, match="must be a response.npz of talbot pixel or .* .it has no response"):
        asked_sensor(options)
