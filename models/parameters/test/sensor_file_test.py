"""A sensor as a file: what is written is read again, what is wrong is named with its meaning and range."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.parameters import (
    STANDARD,
    ArrayParameters,
    ChipParameters,
    OpticsParameters,
    ParameterError,
    PixelType,
    SensorParameters,
    TileParameters,
    read_sensor,
    sensor_of,
    sensor_text,
)
from talbot.models.parameters.sensor_file import keys

OWN = SensorParameters(
    tile=TileParameters(
        1, 3, tuple(PixelType(b, -7.5, 0.1, m) for b, m in ((9, 0.25), (9.5, None), (0, 1))), (2, 0, 1)
    ),
    array=ArrayParameters(60, 90),
    optics=replace(STANDARD.optics, camera=replace(STANDARD.optics.camera, exit_pupil=0.05), m=1 / 3),
    chip=ChipParameters(lanes=2, divider="cordic", f_clk=12.5e6),
)


@pytest.mark.parametrize("sensor", [STANDARD, OWN, SensorParameters()])
def test_what_is_written_is_read_again(tmp_path, sensor):
    path = tmp_path / "sensor.toml"
    path.write_text(sensor_text(sensor))
    assert read_sensor(path) == sensor


def test_every_key_has_its_meaning_with_a_range_or_a_choice():
    text = sensor_text()
    for name, meaning in keys().items():
        assert len(meaning) > 8 and (name in vars(STANDARD) or name == "optics.camera" or f"# {meaning}" in text), name


def test_what_is_left_out_is_the_standard():
    assert sensor_of({}) == STANDARD
    assert sensor_of({"optics": {"m": 0.5, "camera": {"focus": 0.3}}}).optics == OpticsParameters(
        replace(STANDARD.optics.camera, focus=0.3), 0.5
    )
    assert sensor_of({"tile": {"rows": 2, "cols": 3}}).tile == TileParameters.small(2, 3)
    assert sensor_of({"tile": {"rows": 2, "cols": 2, "order": [1, 0, 3, 2]}}).tile.order == (1, 0, 3, 2)


TYPE = {"beta": 1, "gamma_deg": 2, "alpha": 3}


@pytest.mark.parametrize(
    "table, said",
    [
        ({"array": {"rows": 0}}, r"array.rows = 0: must be an integer in 1..1024 \(Pixels, "),
        (
            {"array": {"pitch": "wide"}},
            r"array.pitch = 'wide': must be a number in \[1e-07, 0.001\] \(Pixel pitch, .* m\)",
        ),
        ({"array": {"rows": True}}, "array.rows = True: must be an integer"),
        ({"array": {"row": 3}}, r"array.row = 3: must be a key of \[array\]; did you mean rows\?"),
        ({"camera": {"focus": 1}}, r"must be a key of a sensor; did you mean optics.camera\?"),
        (
            {"optics": {"focus": 1}},
            r"optics.focus = 1: must be a key of \[optics\]; did you mean optics.camera.focus\?",
        ),
        (
            {"optics": {"camera": {"focus": -1}}},
            r"optics.camera.focus = -1: must be a number in .* \(Depth of the focal",
        ),
        ({"nothing": 2}, "nothing = 2: must be a key of a sensor: tile, array, optics, electrical, converter, chip"),
        ({"tile": 3}, r"tile = 3: must be a table, \[tile\]"),
        ({"tile": {"rows": 7}}, r"tile.rows = 7: must be an integer in 1..4"),
        ({"tile": {"order": "abc"}}, "tile.order = 'abc': must be a list"),
        ({"tile": {"order": [0]}}, r"tile.order = \(0,\): must be a permutation of 0..23"),
        ({"tile": {"types": 1}}, "tile.types = 1: must be a list of tables"),
        ({"tile": {"types": [TYPE]}}, "tile.types = 1 entries: must be rows . cols = 24"),
        ({"tile": {"rows": 1, "cols": 1, "types": [TYPE | {"m": 2}]}}, r"tile.types\[0\].m = 2: must be a number in"),
        ({"tile": {"rows": 1, "cols": 1, "types": [{"beta": 1}]}}, r"tile.types\[0\].gamma_deg = None: must be there"),
        ({"tile": {"types": [TYPE | {"response": 1}]}}, r"tile.types\[0\].response = 1: must be a key of"),
        ({"chip": {"lanes": 3}}, "chip.lanes = 3: must be one of 1, 2, 4, 8"),
        ({"array": {"pitch": 1e-4}}, "focal_length = 0.00796: must be a number in"),
    ],
)
def test_what_is_wrong_is_named(table, said):
    with pytest.raises(ParameterError, match=f"^.*{said}") as caught:
        sensor_of(table)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "content, said",
    [
        (b"[array", "must be a TOML file"),
        (b"[array]\nrows = " + b"9" * 5000, "must be a TOML file"),
        (b"\xff\xfe", "must be a TOML file"),
        (b"[array]\nrows = 0", r"array.rows = 0: must be .* \(in .*sensor.toml\)"),
        (b'"a\\nrows = 3" = 1', r"^a\\nrows = 3 = 1: must be a key of a sensor"),
        (b'[array]\n"\\u001b[2K\\u202e" = 1', r"^array\.\\x1b\[2K\\u202e = 1: must be a key of \[array\]"),
        (b"#" * (1 << 21), "at most 1048576 bytes"),
    ],
)
def test_files_that_are_no_sensor(tmp_path, content, said):
    (tmp_path / "sensor.toml").write_bytes(content)
    with pytest.raises(ParameterError, match=said) as caught:
        read_sensor(tmp_path / "sensor.toml")
    assert str(caught.value).isprintable()
    for path in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(ParameterError, match="no such file"):
            read_sensor(path)


def test_a_response_has_no_text():
    tile = TileParameters.of_rows([[PixelType(1, 0, 0, response=lambda x, y: np.ones((2, x.size)))]])
    with pytest.raises(ParameterError, match="tile.types.response = a function: must be None"):
        sensor_text(SensorParameters(tile=tile, array=ArrayParameters(2, 3)))
