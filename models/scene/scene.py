"""What stands in front of the sensor.

Light fields are arrays l[v, u, y, x] everywhere in this project: view row, view column, pixel row, pixel column.
"""

from dataclasses import dataclass

import numpy as np

from models.parameters import ParameterError, check_choice, check_int, check_real

from .camera import DEPTH_MAX

RADIANCE_MAX = 16.0  # 1 = diffuse white; highlights and the saturated target go above it
DTYPES = ("float32", "float64")


@dataclass(frozen=True)
class Sampling:
    """How a scene is sampled: one array size, one angular sampling, one focal plane.

    rows, cols: 1..1536 pixels.  views: along each axis, 1..31.  dtype: 'float32' or 'float64'.
    focus: disparity of the focal plane against the reference plane (models/scene/camera.py), -100..100 px a view
    step, towards the camera; None is the scene's own.
    """

    rows: int = 384
    cols: int = 384
    views: int = 5
    focus: float | None = None
    dtype: str = "float64"

    def __post_init__(self):
        check_int("rows", self.rows, 1, 1536)
        check_int("cols", self.cols, 1, 1536)
        check_int("views", self.views, 1, 31)
        check_choice("dtype", self.dtype, DTYPES)
        if self.focus is not None:
            check_real("focus", self.focus, -100, 100)

    @property
    def shape(self):
        return self.rows, self.cols

    @property
    def steps(self):
        """Offset of every view from the centre, in view steps: (views,)."""
        return np.arange(self.views) - (self.views - 1) / 2

    def focus_or(self, default):
        """The focal plane asked for, or ``default`` (px a view step of a 5 x 5 light field)."""
        return default * 5 / self.views if self.focus is None else float(self.focus)


@dataclass(frozen=True, eq=False)
class Scene:
    """A sampled scene, checked when it is made.

    name: for people.  views: views along each axis that the light field stands for.
    light_field: l[v, u, y, x], radiance 0..16 (1 = diffuse white), (views, views, rows, cols) float32 or float64;
        or (1, 1, rows, cols) where all views are equal.
    image: the centre view, (rows, cols).
    disparity: px a view step towards the camera from the focal plane, (rows, cols), or None where not known:
        view (v, u) sees at (y, x) what the centre view sees at (y + dv * disparity, x + du * disparity).
    depth: m from the camera, 0.001..1000, (rows, cols), or None.
    polarization: S1/S0 and S2/S0, (2, rows, cols), of degree 0..1; None = unpolarized.
    static: nothing moves or changes between the taps of a time-of-flight frame.
    Raises ParameterError for a wrong shape or type, NaN, infinity or a value out of range.
    """

    name: str
    views: int
    light_field: np.ndarray
    image: np.ndarray
    disparity: np.ndarray | None = None
    depth: np.ndarray | None = None
    polarization: np.ndarray | None = None
    static: bool = True

    def __post_init__(self):
        check_int("views", self.views, 1, 31)
        field = self.light_field
        check_choice("light_field dtype", str(field.dtype), DTYPES)
        if field.ndim != 4 or field.shape[:2] not in ((self.views, self.views), (1, 1)) or 0 in field.shape:
            raise ParameterError(
                f"light_field shape = {field.shape}: must be (views, views, rows, cols) or "
                f"(1, 1, rows, cols) with views = {self.views}"
            )
        check_values("light_field", field, 0, RADIANCE_MAX)
        for name, low, high, shape in (
            ("image", 0, RADIANCE_MAX, self.shape),
            ("disparity", -1e4, 1e4, self.shape),
            ("depth", 1e-3, DEPTH_MAX, self.shape),
            ("polarization", -1, 1, (2, *self.shape)),
        ):
            value = getattr(self, name)
            if value is None:
                continue
            if value.shape != shape:
                raise ParameterError(f"{name} shape = {value.shape}: must be {shape}")
            check_values(name, value, low, high)
        if self.polarization is not None:
            check_values("degree of polarization", np.hypot(*self.polarization), 0, 1 + 1e-6)

    @property
    def shape(self):
        """(rows, cols)."""
        return self.light_field.shape[2:]

    @property
    def angular(self):
        """Whether the views may differ."""
        return self.light_field.shape[:2] != (1, 1)

    @property
    def full_light_field(self):
        """The light field with every view there, (views, views, rows, cols): a read-only view, no copies."""
        return np.broadcast_to(self.light_field, (self.views, self.views, *self.shape))


def check_values(field, values, low, high):
    """Raise ParameterError unless every element of the array ``values`` is finite and in [low, high]."""
    # min and max pass NaN on, so that two passes see everything.
    smallest, largest = float(np.min(values)), float(np.max(values))
    if not (low <= smallest and largest <= high):
        worst = smallest if not low <= smallest else largest
        raise ParameterError(f"{field} = {worst:g}: every value must be a finite number in [{low:g}, {high:g}]")
