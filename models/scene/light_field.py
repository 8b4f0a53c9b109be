"""A light field as data: an array [v, u, y, x] or [v, u, y, x, rgb] of one's own, seen by the sensor as a scene.

View (v, u) is the scene from the pupil's row v, from above, and column u, from the left: the sensor has as many views
as the light field.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_int

from . import resample
from .picture_file import decode16
from .sampling import Sampling
from .scene import RADIANCE_MAX, Scene, check_values

CODES = ("uint8", "uint16")
FLOATS = ("float16", "float32", "float64")
REC709 = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True, eq=False)
class LightField:
    """A light field, checked when it is created.

    Attributes
    ----------
    values : array (views, views, height, width) or (views, views, height, width, 3)
        l[v, u, y, x], gray or RGB, 1..31 views each way. uint8 and uint16 are sRGB codes; float16 to float64 is linear
        radiance, 0..16, 1 = diffuse white.
    disparity : array (height, width) or None
        Of the middle view in its pixels per view step, -1e4..1e4, positive towards the camera: view (v, u) shows at
        (y, x) what the middle one shows at (y + dv d, x + du d). Without it no image is rebuilt from edges.
    name : str
        Name in reports.

    Raises
    ------
    ParameterError
        For a wrong shape or type, NaN, infinity or a value out of range.
    """

    values: npt.NDArray[Any]
    disparity: npt.NDArray[Any] | None = None
    name: str = "light_field"

    def __post_init__(self) -> None:
        values = np.asarray(self.values)
        object.__setattr__(self, "values", values)
        shape = values.shape
        if len(shape) not in (4, 5) or 0 in shape or shape[0] != shape[1] or shape[4:] not in ((), (3,)):
            raise ParameterError(
                f"light field = array of shape {shape}: must be (views, views, height, width), or with 3 colours behind"
            )
        check_int("views", len(values), 1, 31)
        if values.dtype.name not in CODES + FLOATS:
            raise ParameterError(f"light field = {values.dtype} array: must be of {', '.join(CODES + FLOATS)}")
        if values.dtype.name in FLOATS:
            check_values("light field", values, 0, RADIANCE_MAX)
        if self.disparity is not None:
            disparity = np.asarray(self.disparity)
            object.__setattr__(self, "disparity", disparity)
            if disparity.shape != shape[2:4] or disparity.dtype.kind not in "iuf":
                raise ParameterError(
                    f"disparity = {disparity.dtype} array of shape {disparity.shape}: must be numbers, {shape[2:4]}"
                )
            check_values("disparity", disparity, -1e4, 1e4)

    @property
    def views(self) -> int:
        """Views along each axis."""
        return len(self.values)

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width of a view."""
        return self.values.shape[2], self.values.shape[3]

    def view(self, v: int, u: int) -> npt.NDArray[np.float64]:
        """Radiance of a view.

        Parameters
        ----------
        v, u : int
            Its row and column.

        Returns
        -------
        float64 (height, width)
            Linear luminance, 0..16.
        """
        codes = self.values[v, u]
        if codes.dtype == np.uint8:
            return resample.linear(codes).astype(float)
        light = decode16(codes / 65535) if codes.dtype == np.uint16 else codes.astype(float)
        return light @ REC709 if light.ndim == 3 else light

    def scene(self, sampling: Sampling) -> Scene:
        """The light field before a sensor.

        Parameters
        ----------
        sampling : Sampling
            Array; its number of views is not used.

        Returns
        -------
        Scene
            Of the array's size: the largest centred part with its proportions. Depth is not known.
        """
        size, middle = sampling.shape, self.views // 2
        box = resample.centre_box(*self.shape, *size)
        same = self.shape == size
        field = np.empty((self.views, self.views, *size), sampling.dtype)
        for v, u in np.ndindex(self.views, self.views):
            light = self.view(v, u)
            # Means may round past the ends
            field[v, u] = light if same else np.clip(resample.resize(light, *size, box), 0, RADIANCE_MAX)
        disparity = None
        if self.disparity is not None:
            zoom = sampling.cols / (box[2] - box[0])
            disparity = np.clip(resample.pick(self.disparity, *size, box) * zoom, -1e4, 1e4)
        image = field[middle, middle].copy()
        if (field == image).all():
            field = field[:1, :1]
        return Scene(self.name, self.views, field, image, disparity)
