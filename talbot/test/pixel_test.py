"""The pixel by its public name and on the command line, and a chip whose pixels respond as a process's gratings do."""

import json

import numpy as np
import pytest

import talbot
from talbot.commands import main
from talbot.models.parameters import ParameterError


def test_a_solution_by_the_public_name():
    geometry = talbot.pixel.PixelGeometry(period_um=0.74)
    found = talbot.pixel.solve(geometry, np.deg2rad([0, 7, 14]), 550e-9, orders=15)
    assert found.shares.shape == (1, 2, 4, 3) and 0 < found.shares.min() < found.shares.max() < 0.5
    for wavelength, said in ((550, "must be in m"), (2e-6, r"wavelength_um = 2: must be in \[0.35, 1\]")):
        with pytest.raises(ParameterError, match=said):
            talbot.pixel.solve(geometry, [0.0], wavelength)
    for angles, said in (([], "must be a list of one or more"), ([np.pi / 2], "must be an angle in rad below pi/2")):
        with pytest.raises(ParameterError, match=said):
            talbot.pixel.solve(geometry, angles, 550e-9)


@pytest.mark.parametrize(
    "words, said",
    [
        ("pixel --pdk tsmc", "pdk = 'tsmc': must be one of sky130, ihp-sg13g2"),
        ("pixel --kind phase", "kind = 'phase': must be one of amplitude, interleaved, photogate, all"),
        ("pixel --heights high", "heights = 'high': must be one of met2-2.006, met2-2.301"),
        ("pixel --pdk ihp-sg13g2 --kind photogate", "kind = photogate: must be one that ihp-sg13g2 can make"),
        ("pixel --period-um 0.5", "period_um = 0.5: must be at least 0.6, met4's width and space in sky130"),
        ("pixel --period-um 12", "period_um = 12.0: must be a number in [0.1, 5.0]"),
        ("pixel --period-um wide", "period_um = 'wide': must be a number in [0.1, 50]"),
        ("pixel --diffraction met9", "diffraction = 'met9': must be one of met1, met2, met3, met4, met5"),
        ("pixel --diffraction met1 --analyzer met4", "must be below diffraction = 'met1' (gap -3.490 um)"),
        ("pixel --fill 0.05 --period-um 0.7", "fill = 0.05: must be in [0.429, 0.571]"),
        ("pixel --shift 3", "shift = '3': must be a number in [-1, 1]"),
        ("pixel --wavelength-um 550", "wavelength_um = '550': must be a number in [0.35, 1]"),
        ("pixel --kind interleaved --analyzer met1", "analyzer = 'met1': must be None"),
        ("pixel --kind photogate --period-um 1", "analyzer = 'met1': must be poly"),
        ("pixel-circuit --pdk ihp-sg13g2", "pdk = 'ihp-sg13g2': must be one of sky130"),
        ("pixel-circuit --corners tt_30", "corners = 'tt_30': must be all, typical, or some of tt_-40"),
        ("pixel-circuit --gate 9", "gate_v = 9.0: must be"),
        ("pixel-circuit --sink 0", "sink_a = 0.0: must be"),
        ("sim --pixel gf180", "pixel = 'gf180': must be one of ideal, sky130, ihp-sg13g2, sky130-endless"),
    ],
)
def test_refused_in_one_line(words, said, capsys):
    assert main(words.split()) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1


def test_one_geometry_on_the_command_line(tmp_path, capsys):
    """What is written is what the library gives."""
    words = f"pixel --kind interleaved --diffraction met3 --period-um 1.1 --out {tmp_path / 'one'}"
    assert main(words.split()) == 0
    assert "sky130: interleaved pixel, met3, period 1.1 um, at 550 nm" in capsys.readouterr().out
    geometry = talbot.pixel.PixelGeometry(kind="interleaved", diffraction="met3", analyzer=None, period_um=1.1)
    with np.load(tmp_path / "one" / "response.npz") as kept:
        found = talbot.pixel.solve(geometry, kept["angles"][[0, 50]], kept["wavelengths"])
        np.testing.assert_allclose(kept["response"][:, [0, 50]], found.shares.transpose(2, 3, 0, 1), atol=1e-9)
    summary = json.loads((tmp_path / "one" / "summary.json").read_text())
    assert summary["period_um"] == 1.1 and summary["analyzer"] is None and 0 < summary["m"] < 1


def test_pixels_by_name_as_on_the_command_line(tmp_path):
    """The same bytes; the name is shown, kept and taken back."""
    plain = talbot.Sensor(rows=13, cols=50, lanes=4, f_number=2)
    sensor = plain.replace(pixel="sky130")
    assert sensor == talbot.Sensor(rows=13, cols=50, lanes=4, f_number=2, pixel="sky130") != plain
    assert "pixel='sky130'" in repr(sensor) and "tile" not in repr(sensor)
    assert sensor.replace(m=0.5).replace(pixel="ideal") == plain.replace(m=0.5)
    codes = np.random.default_rng(0).integers(0, 256, (3, 3, 13, 50, 3), np.uint8)
    talbot.LightField(codes).save(tmp_path / "lf")
    plain.save(tmp_path / "sensor.toml")
    words = ["--scene", tmp_path / "lf", "--sensor", tmp_path / "sensor.toml", "--out", tmp_path / "out"]
    assert main(["sim", "--pixel", "sky130", *map(str, words)]) == 0
    stream = (tmp_path / "out" / "stream.bin").read_bytes()
    assert stream == sensor.golden(tmp_path / "lf").stream != plain.golden(tmp_path / "lf").stream
    with pytest.raises(
        ParameterError, match="pixel = 'gf180': must be one of ideal, sky130, ihp-sg13g2, sky130-endless"
    ):
        talbot.Sensor(pixel="gf180")


@pytest.mark.slow  # eight runs; a table of endless gratings takes half a minute
@pytest.mark.parametrize("pixel", ["sky130", "sky130-endless"])
def test_a_chip_with_tables_is_equal_to_its_model(pixel):
    sensor = talbot.Sensor(rows=24, cols=36, lanes=4, pixel=pixel)
    assert f"# its response is that of PIXEL={pixel}" in sensor.text
    for mode in ("edge", "image", "raw", "tof"):
        run = sensor.simulate("motorcycle", mode=mode)
        assert run.summary["stream_mismatches"] == run.summary["decoded_mismatches"] == 0
