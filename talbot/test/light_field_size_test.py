"""A light field of one's own: the sensor has its size, or says what it changes; disparities by its views."""

from argparse import ArgumentParser

import numpy as np
import pytest

from talbot import LightField, Sensor
from talbot.imaging.frame import command
from talbot.imaging.frame.light_field import prior_of


@pytest.fixture
def path(tmp_path):
    values = np.random.default_rng(0).integers(0, 256, (3, 3, 20, 30), np.uint8)
    np.save(tmp_path / "x.npy", values)
    return str(tmp_path / "x.npy")


def size_of(*words):
    parser = ArgumentParser()
    command.add_arguments(parser)
    return command.request_of(parser.parse_args(words)).sensor.shape


def test_make_sim_takes_the_size_of_a_light_field(tmp_path, path, capsys):
    assert size_of("--scene", path) == (20, 30)
    assert not capsys.readouterr().err
    assert size_of("--scene", path, "--rows=40", "--cols=60") == (40, 60)
    assert capsys.readouterr().err == "talbot: light field x: 20 x 30 px enlarged 2 times to the sensor's 40 x 60\n"
    (tmp_path / "sensor.toml").write_text("[array]\nrows = 10\ncols = 15\n")
    assert size_of("--scene", path, "--sensor", str(tmp_path / "sensor.toml")) == (10, 15)
    assert "reduced 2 times to the sensor's 10 x 15" in capsys.readouterr().err
    assert size_of("--scene", "coins") == (384, 384)


@pytest.mark.parametrize("form", [str, np.load, lambda path: LightField(np.load(path))])
def test_a_sensor_without_a_size_takes_it_too(path, form, capsys):
    scene = form(path)
    assert Sensor()._request(scene, "edge", {}).sensor.shape == (20, 30)
    assert Sensor(m=0.5).replace(m=0.6)._request(scene, "edge", {}).sensor.shape == (20, 30)
    assert not capsys.readouterr().err
    assert Sensor(rows=40)._request(scene, "edge", {}).sensor.shape == (40, 384)
    assert Sensor().replace(cols=15)._request(scene, "edge", {}).sensor.shape == (384, 15)
    assert Sensor().golden(scene, "raw").samples.shape[:2] == (20, 30)


def test_views_that_are_not_taken_are_told(tmp_path, capsys):
    np.save(tmp_path / "grid.npy", np.zeros((3, 5, 20, 30), np.uint8))
    assert size_of("--scene", str(tmp_path / "grid.npy")) == (20, 30)
    assert capsys.readouterr().err == "talbot: light field grid: of 3 x 5 views the middle 3 x 3 are taken\n"


@pytest.mark.parametrize("views, near", [(1, 12.5), (5, 2.5), (17, 12.5 / 17)])
def test_disparities_that_are_tried_span_the_pupil(views, near):
    """The views' number changes a step, not the range."""
    field = LightField(np.random.default_rng(0).integers(0, 256, (views, views, 16, 24), np.uint8))
    result = Sensor().golden(field, "raw").result
    prior = prior_of(result)
    assert (prior.near, prior.far) == (near, -near)
    assert (prior_of(result, near=1.0).near, prior_of(result, far=-3.0).far) == (1, -3)
