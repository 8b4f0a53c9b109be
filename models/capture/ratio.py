"""How fast the capture operator is, measured against copying the light field."""

from time import perf_counter

import numpy as np

from models.parameters import SensorParameters

from .operator import CaptureOperator


def capture_ratio(sensor=None, dtype="float64", repeats=5):
    """Time of CaptureOperator.forward over the time of copying its light field, both the best of ``repeats``.

    sensor: SensorParameters, default the 384 x 384 sensor with 5 x 5 views.
    """
    operator = CaptureOperator(sensor or SensorParameters(), dtype)
    light_field = np.random.default_rng(0).random(operator.shape, operator.dtype)
    operator.forward(light_field)  # compile, and lay the weights out
    return _best(lambda: operator.forward(light_field), repeats) / _best(light_field.copy, repeats)


def _best(run, repeats):
    times = []
    for _ in range(repeats):
        start = perf_counter()
        run()
        times.append(perf_counter() - start)
    return min(times)
