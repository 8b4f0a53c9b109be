"""Speed of the capture operator relative to a copy of its light field, and of the plan's omissions (make bench)."""

import numpy as np
import pytest

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import SensorParameters

SENSOR = SensorParameters()


@pytest.fixture(params=["float32", "float64"])
def whole(request):
    operator = CaptureOperator(SENSOR, request.param)
    return operator, np.random.default_rng(0).random(operator.shape, operator.dtype)


def test_copy(benchmark, whole):
    benchmark(whole[1].copy)


def test_forward(benchmark, whole):
    operator, light = whole
    assert benchmark(operator.forward, light).shape == (2, 384, 384)


def test_transpose(benchmark, whole):
    operator, light = whole
    assert benchmark(operator.transpose, operator.forward(light)).shape == light.shape


def test_forward_of_one_type(benchmark, whole):
    operator, light = whole
    kinds = SENSOR.tile.type_map(384, 384)
    assert benchmark(CaptureOperator(SENSOR, operator.dtype, read=kinds == 3).forward, light).any()


def test_forward_of_one_view(benchmark, whole):
    operator, light = whole
    assert benchmark(CaptureOperator(SENSOR, operator.dtype, angular=False).forward, light[:1, :1]).any()
