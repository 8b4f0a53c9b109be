"""Speed of the ways back at 384 x 384 (make bench)."""

import numpy as np
import pytest

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import SensorParameters
from talbot.models.pixel import optical_gains
from talbot.models.reconstruct import EdgeOperator, demosaic, image_from_edges, light_field_estimate
from talbot.models.scene import Sampling, load

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


def test_light_field_estimate(benchmark):
    operator = CaptureOperator(SENSOR)
    pair = np.random.default_rng(0).random((2, 384, 384))
    assert benchmark(light_field_estimate, operator, pair).shape == (5, 5, 384, 384)
