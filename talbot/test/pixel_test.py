"""The pixel by its public name and on the command line, and a chip whose pixels respond as a process's gratings do."""

import numpy as np
import pytest

import talbot
from talbot.commands import main
from talbot.models.parameters import ParameterError
from talbot.pixels.tabled import tabled


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
        ("sim --pixel gf180", "pixel = 'gf180': must be one of ideal, sky130, ihp-sg13g2"),
    ],
)
def test_refused_in_one_line(words, said, capsys):
    assert main(words.split()) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1


@pytest.mark.slow  # a table takes half a minute
def test_a_chip_with_tables_is_equal_to_its_model(tmp_path):
    sensor = talbot.Sensor.of(tabled(talbot.Sensor(rows=24, cols=36, lanes=4).parameters, "sky130"))
    assert "# its response is that of PIXEL=sky130" in sensor.text
    for mode in ("edge", "image", "raw", "tof"):
        run = sensor.simulate("motorcycle", mode=mode)
        assert run.summary["stream_mismatches"] == run.summary["decoded_mismatches"] == 0
