"""Speed of the capture operator relative to copying the light field."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from talbot.models.capture.operator import CaptureOperator
from talbot.models.parameters import SensorParameters


def capture_ratio(sensor: SensorParameters | None = None, dtype: str = "float64", repeats: int = 5) -> float:
    """Time of CaptureOperator.forward over the time of copying its light field.

    Parameters
    ----------
    sensor : SensorParameters, optional
        By default 384 x 384 pixels and 5 x 5 views.
    dtype : str
        'float32' or 'float64'.
    repeats : int
        Number of repetitions; both times are the best of these.

    Returns
    -------
    float
        Ratio.
    """
    operator = CaptureOperator(sensor or SensorParameters(), dtype)
    light_field = np.random.default_rng(0).random(operator.shape, operator.dtype)
    operator.forward(light_field)  # compile, and prepare the weights
    return _best(lambda: operator.forward(light_field), repeats) / _best(light_field.copy, repeats)


def _best(run: Callable[[], object], repeats: int) -> float:
    times = []
    for _ in range(repeats):
        start = perf_counter()
        run()
        times.append(perf_counter() - start)
    return min(times)
