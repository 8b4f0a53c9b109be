"""The ordinary 2-D image: the sum of each pair [Jayasuriya2017, Eq. 3.6]."""

from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.digital.exposure import integration_cycles
from talbot.models.parameters import ELEMENTARY_CHARGE, AmpTiming, ElectricalParameters, SensorParameters
from talbot.models.pixel.weights import view_weights

FULL = 255.0  # LSB: both wells of a pair full


def white_sum(sensor: SensorParameters, timing: AmpTiming = AmpTiming()) -> float:
    """Sum of a pair in a flat white scene, on average over the types, without full wells.

    sensor: the sensor. timing: integration time. Returns float: in LSB.
    """
    e = sensor.electrical
    seconds = integration_cycles(timing)[-1] / sensor.chip.f_clk  # a common-mode reset takes the sum away
    return 2 * e.white_current * seconds / ELEMENTARY_CHARGE / e.lsb_electrons


def _still(e: ElectricalParameters) -> float:
    """Variance of a diode's samples that light does not change, electrons squared."""
    return e.read_noise**2 + e.offset_fpn**2 + e.column_fpn**2 + e.flicker_noise**2


def sum_noise(
    image: npt.NDArray[np.floating], sensor: SensorParameters, timing: AmpTiming = AmpTiming()
) -> npt.NDArray[np.floating]:
    """Standard deviation of `sum_image` that physics and the converter leave at noise 1.

    image: (rows, cols), relative radiance. sensor: the sensor. timing: integration time. Returns (rows, cols), shot,
    read and fixed-pattern noise, and rounding to codes; 1 is white.
    """
    e = sensor.electrical
    white = white_sum(sensor, timing) * e.lsb_electrons
    still = 2 * _still(e)
    light = np.maximum(image, 0) * white
    pattern = (e.gain_fpn * light) ** 2 / 2
    return np.sqrt(light + still + pattern + e.lsb_electrons**2 / 12) / white


def diode_noise(
    light: npt.ArrayLike, sensor: SensorParameters, timing: AmpTiming = AmpTiming(), noise: float = 1.0
) -> npt.NDArray[np.floating]:
    """Standard deviation of a diode's code in a raw frame.

    light: on the diode, 1 = the average diode in a flat white scene. sensor: the sensor. timing: integration time,
    without common-mode resets. noise: factor on shot, read and fixed-pattern noise, 0..100; rounding and the
    converter's own errors have none. Returns array: in the unit of ``light``.
    """
    e, c = sensor.electrical, sensor.converter
    white = white_sum(sensor, timing) * e.lsb_electrons / 2
    electrons = np.maximum(light, 0) * white
    still = _still(e)
    analog = electrons + still + (e.gain_fpn * electrons) ** 2
    code = e.lsb_electrons / 2  # raw codes are of twice a diode
    codes = 1 / 12 + c.noise**2 + c.ktc**2 + c.offset**2 + c.dnl**2 + c.inl**2 / 2  # a bow's mean square is half
    return np.sqrt(noise**2 * analog + codes * code**2) / white


def sum_image(
    sums: npt.NDArray[Any],
    sensor: SensorParameters,
    read: npt.NDArray[np.bool_] | None = None,
    timing: AmpTiming = AmpTiming(),
) -> npt.NDArray[np.floating]:
    """Relative radiance of every pixel from the sum of its pair; each type's share of the common mode is divided out.

    sums: (rows, cols), in LSB; clipped to 0..255. sensor: the sensor. read: (rows, cols), pixels that are read; the
    others take the value of the nearest one that is. None is all. timing: integration time. Returns (rows, cols), 0 or
    more; 1 is white. Source: [Jayasuriya2017], Eq. 3.6.
    """
    share = view_weights(sensor.tile, sensor.optics).sum((1, 2, 3)) / 2
    white = white_sum(sensor, timing) * share[sensor.tile.type_map(*sums.shape)]
    out = np.clip(sums, 0, FULL) / white
    if read is None or read.all():
        return out
    if not read.any():
        return np.zeros_like(out)
    from scipy.ndimage import distance_transform_edt  # it imports for long

    nearest = np.asarray(distance_transform_edt(~read, return_distances=False, return_indices=True))
    return out[nearest[0], nearest[1]]
