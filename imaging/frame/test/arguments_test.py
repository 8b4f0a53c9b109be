from argparse import ArgumentParser

import pytest

from talbot.base.arguments import span
from talbot.imaging.frame.arguments import named, pixel_types, window
from talbot.imaging.frame.command import add_arguments, request_of, typed_of
from talbot.models.parameters import (
    ALL_TYPES,
    STANDARD,
    ConverterParameters,
    ElectricalParameters,
    ParameterError,
    SensorParameters,
    Window,
    circuit_columns,
    circuit_converter,
    drawn_electrical,
    sensor_text,
)

FULL = Window(0, 95, 0, 63)


@pytest.mark.parametrize(
    "text, mask",
    [
        ("all", ALL_TYPES),
        ("low", 0xFF),
        ("low,high", 0xFF00FF),
        ("0x10", 0x10),
        ("0,2,23", 0x800005),
        ("cosine", 0x555555),
    ],
)
def test_pixel_types(text, mask):
    assert pixel_types(text) == mask


@pytest.mark.parametrize("text", ["", "24", "-1", "0x0", "0x1000000", "lows", "0x", "1,,2"])
def test_pixel_types_refused(text):
    with pytest.raises(ParameterError, match="types = "):
        pixel_types(text)


def test_window():
    assert window("full", FULL) == FULL
    assert window("3:7,2:2", FULL) == Window(3, 7, 2, 2)
    assert window("3,2:5", FULL) == Window(3, 3, 2, 5)


@pytest.mark.parametrize("text", ["1:2", "5:2,0:3", "0:96,0:3", "0:3,0:64", "a:b,0:1", "-1:3,0:1"])
def test_window_refused(text):
    with pytest.raises(ParameterError, match="window"):
        window(text, FULL)


def test_span_names_field_value_and_range():
    with pytest.raises(ParameterError, match=r"waves = '9:12'|waves = '12'.*0\.\.10"):
        span("waves", "9:12", 0, 10)


def parsed(*words):
    parser = ArgumentParser()
    add_arguments(parser)
    return parser.parse_args(words)


def test_the_circuits_converters_are_asked_for():
    found = request_of(parsed())
    assert found.sensor.converter == circuit_converter() and found.sensor.converter.unit_mismatch > 0
    assert found.columns is None
    assert request_of(parsed("--converter", "ideal")).sensor.converter == ConverterParameters()
    found = request_of(parsed("--afe", "circuit"))
    assert found.columns == circuit_columns() and found.sensor.converter == circuit_converter()
    electrical = found.sensor.electrical
    assert electrical == drawn_electrical(ElectricalParameters()) and electrical.full_well > 1.1e5
    assert typed_of(parsed("--afe", "circuit"), add_arguments)["afe"] == "circuit"


def test_with_the_circuits_a_sensor_file_has_their_converters(tmp_path):
    file = tmp_path / "sensor.toml"
    file.write_text(sensor_text(STANDARD))
    assert request_of(parsed("--sensor", str(file), "--afe", "circuit")).sensor.converter == circuit_converter()
    file.write_text(sensor_text(SensorParameters()))
    assert request_of(parsed("--sensor", str(file))).sensor.converter == ConverterParameters()
    with pytest.raises(ParameterError, match=r"converter.inl = 0: must be 0.2 \(afe = circuit"):
        request_of(parsed("--sensor", str(file), "--afe", "circuit"))


def test_afe_is_refused_by_name():
    with pytest.raises(ParameterError, match="afe = 'spice': must be one of ideal, circuit"):
        request_of(parsed("--afe", "spice"))
    with pytest.raises(ParameterError, match="converter = 'ideal': must be left out with afe = circuit"):
        request_of(parsed("--afe", "circuit", "--converter", "ideal"))


@pytest.mark.parametrize("scene, name", [("photos/a.b.png", "a.b"), ("coins", "coins"), ("moving:40", "moving:40")])
def test_the_name_of_a_scene(scene, name):
    assert named(scene) == name


@pytest.mark.parametrize("scene", [".", "x/..", "./", "x/."])
def test_a_folder_has_its_own_name_however_it_is_given(scene, tmp_path, monkeypatch):
    (tmp_path / "views" / "x").mkdir(parents=True)
    monkeypatch.chdir(tmp_path / "views")
    assert named(scene) in ("views", "x") and named("/") == "root"
