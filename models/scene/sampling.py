"""Sampling of a scene: array size, views and camera."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import (
    ArrayParameters,
    CameraParameters,
    SensorParameters,
    check_choice,
    check_int,
    check_real,
)

DTYPES = ("float32", "float64")


@dataclass(frozen=True)
class Sampling:
    """Array size, angular sampling and camera of a scene.

    Attributes
    ----------
    rows, cols : int
        1..1536 pixels.
    views : int
        Views along each axis, 1..31.
    camera : CameraParameters
        The lens, its focus, and the scale of the scene.
    pitch : float
        Of the pixels, 1e-7..1e-3 m.
    dtype : str
        'float32' or 'float64', the type of the light field.
    light : tuple of (float, float)
        Wavelengths in m and their weights in the electrons, of sum 1; empty is one wavelength, a scene's own.
    """

    rows: int = 384
    cols: int = 384
    views: int = 5
    camera: CameraParameters = CameraParameters()
    pitch: float = ArrayParameters.pitch
    dtype: str = "float64"
    light: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        check_int("rows", self.rows, 1, 1536)
        check_int("cols", self.cols, 1, 1536)
        check_int("views", self.views, 1, 31)
        check_choice("dtype", self.dtype, DTYPES)
        check_real("pitch", self.pitch, 1e-7, 1e-3)

    @classmethod
    def of(cls, sensor: SensorParameters, dtype: str = "float64") -> Self:
        """Sampling of a sensor.

        sensor: the sensor. dtype: 'float32' or 'float64'. Returns Sampling: with the sensor's array, views and camera.
        """
        array, optics = sensor.array, sensor.optics
        return cls(array.rows, array.cols, optics.views, optics.camera, array.pitch, dtype)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.rows, self.cols

    @property
    def steps(self) -> npt.NDArray[np.float64]:
        """Offset of every view from the centre, in view steps: (views,)."""
        return np.arange(self.views, dtype=np.float64) - (self.views - 1) / 2
