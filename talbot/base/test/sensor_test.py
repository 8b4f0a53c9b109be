"""A command's sensor: file and options make one, fixed fields and limits are refused by name."""

from argparse import ArgumentParser

import pytest

from talbot.base.sensor import Varied, add_sensor, labelled, sensor_asked
from talbot.models.parameters import STANDARD, ParameterError, TileParameters
from talbot.models.parameters.sensor_file import keys, values

FIELDS = {"rows": "array.rows", "tile-rows": "tile.rows", "order": "tile.order", "lanes": "chip.lanes"}

ROWS = Varied(used=("array.rows",))


@pytest.fixture
def asked(tmp_path):
    """The sensor of a file's text and options."""

    def sensor(text, *words, varied=ROWS):
        (tmp_path / "odd.toml").write_text(text)
        parser = ArgumentParser()
        add_sensor(parser, FIELDS)
        return sensor_asked(parser.parse_args([f"--sensor={tmp_path / 'odd.toml'}", *words]), varied, FIELDS)

    return sensor


def test_values_have_the_names_of_keys():
    assert set(values(STANDARD)) <= set(keys()) and values(STANDARD)["optics.camera.focus"] == 0.207


def test_options_replace_fields_of_the_file(asked):
    text = "array.rows = 40\narray.cols = 50\ntile.rows = 2\ntile.cols = 3"
    assert asked(text).shape == (40, 50)
    sensor = asked(text, "--rows=60", "--order=5,4,3,2,1,0", "--lanes=2")
    assert sensor.shape == (60, 50) and sensor.tile.order == (5, 4, 3, 2, 1, 0) and sensor.chip.lanes == 2
    assert asked(text, "--tile-rows=1").tile == TileParameters.small(1, 3)
    assert asked("array.rows = 256\ntile.rows = 1\ntile.cols = 6", "--rows=1024", "--tile-rows=4").tile_rows == 256


@pytest.mark.parametrize(
    "words, said",
    [
        (["--rows=0"], "^rows = 0: must be an integer in 1..1024$"),
        (["--lanes=3"], "^lanes = 3: must be one of 1, 2, 4"),
        (["--order=a,b"], "^order = 'a,b': must be a permutation of 0..23, as 3,0,2,1$"),
        (["--order=0,1"], r"^order = \(0, 1\): must be a permutation of 0..23$"),
    ],
)
def test_a_wrong_option_is_named(asked, words, said):
    with pytest.raises(ParameterError, match=said):
        asked("", *words)


@pytest.mark.parametrize(
    "text, said",
    [
        ("array.pitch = 12e-6", r"array.pitch = 1.2e-05: must be 1e-05 \(drawn; this command varies array.rows\)"),
        ("tile.rows = 2", r"tile.rows = 2: must be 4 \(drawn; "),
        (f"tile.order = {[*reversed(range(24))]}", r"tile.order = 23,22,21,.*: must be 0,9,20,.* \(drawn; "),
        ("array.rows = 40", r"array.rows = 40: must be in 100..400 \(this command varies array.rows\)"),
        ("array.rows = 206", r"array.rows = 206: must be a multiple of 4 \(this command varies array.rows\)"),
        ("optics.camera.exit_pupil = 0.05", r"optics.camera.exit_pupil = 0.05: must be None \(drawn; "),
    ],
)
def test_what_a_command_cannot_vary_is_refused_in_a_line(asked, text, said):
    fixed = dict.fromkeys(("array.pitch", "tile", "optics.camera"), "drawn")
    varied = Varied(("array.rows",), fixed, {"array.rows": (100, 400)}, {"array.rows": 4})
    assert asked("optics.m = 0.5\narray.rows = 200", varied=varied).optics.m == 0.5
    with pytest.raises(ParameterError, match=f"^{said}") as caught:
        asked(text, varied=varied)
    assert "\n" not in str(caught.value)


def test_results_of_a_sensor_file_have_its_name():
    parser = ArgumentParser()
    add_sensor(parser)
    assert labelled("sky130", parser.parse_args([])) == "sky130"
    assert labelled("sky130", parser.parse_args(["--sensor=my/odd.toml"])) == "sky130-odd"
