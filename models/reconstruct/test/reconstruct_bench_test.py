"""Speed of the ways back at 384 x 384 (make bench)."""

import numpy as np
import pytest

from models.parameters import SensorParameters
from models.pixel import optical_gains
from models.reconstruct import EdgeOperator, demosaic, image_from_edges, linear_light_field
from models.scene import Sampling, load

SENSOR = SensorParameters()


@pytest.fixture(scope="module")
def edges():
    scene = load("motorcycle", Sampling())
    operator = EdgeOperator(SENSOR, scene.disparity, optical_gains(SENSOR.tile, SENSOR.optics))
    return operator, operator.forward(scene.image)


def test_image_from_edges(benchmark, edges):
    operator, samples = edges
    assert benchmark.pedantic(image_from_edges, (samples, operator), rounds=3).std() > 0


def test_demosaic(benchmark, edges):
    assert benchmark(demosaic, edges[1], SENSOR.tile).shape == (24, 384, 384)


def test_linear_light_field(benchmark):
    pairs = np.random.default_rng(0).random((384, 384, 2))
    assert benchmark(linear_light_field, pairs, SENSOR, 100.0).shape == (5, 5, 384, 384)
