"""The scene in front of the sensor.

Light fields are arrays l[v, u, y, x] everywhere in this project: view row, view column, pixel row, pixel column.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import FOCUS_MAX, ParameterError, check_choice, check_int, check_real
from talbot.models.scene.echo import Echo
from talbot.models.scene.sampling import DTYPES

Bools = npt.NDArray[np.bool_]
# Radiance and disparity (rows, cols) of the view at an offset (dv, du) in view steps, at most views / 2 each way
View = Callable[[float, float], tuple[npt.NDArray[np.floating], npt.NDArray[np.floating]]]

SPEED_MAX = 1e7  # px/s
RADIANCE_MAX = 16.0  # 1 = diffuse white; highlights and the saturated target go above it


class Kept:
    """The ``render`` of a scene that was copied or read again: its light field alone is there."""


@dataclass(frozen=True, eq=False)
class Scene:
    """A sampled scene, checked when it is created.

    Attributes
    ----------
    name : str
        Name in reports.
    views : int
        Views along each axis that the light field represents, 1..31.
    field : float32 or float64 (views, views, rows, cols), or None
        l[v, u, y, x], radiance 0..16 (1 = diffuse white); (1, 1, rows, cols) where all views are equal; None: what
        ``render`` gives, when it is asked for.
    image : float32 or float64 (rows, cols)
        The centre view.
    disparity : array (rows, cols) or None
        Px per view step towards the camera from the focal plane; None if not known. View (v, u) shows at (y, x) what
        the centre view shows at (y + dv * disparity, x + du * disparity).
    depth : array (rows, cols) or None
        Distance from the camera, 0.001..1000 m.
    polarization : array (2, rows, cols) or (2, views, views, rows, cols), or None
        S1/S0 and S2/S0 of the centre view, or of every view, of degree 0..1; None is unpolarized.
    specular : bool (rows, cols) or None
        Where the centre view shows a reflection brighter than half of the lamp that it is of; None if not known.
    behind : array (rows, cols) or None
        Distance from the camera of the surface behind an occluder, 0.001..1000 m.
    surfaces : array (views, views, rows, cols) or None
        Disparity of what every view of the light field shows; None: as the centre view's.
    echo : Echo or None
        Where the light of time of flight has been; None: straight to the surface and back.
    render : callable, Kept or None
        From the wanted pixels, bool (rows, cols), to a `View` of these, those of the light field and all between; None:
        there are no others.
    static : bool
        Nothing moves or changes between the taps of a time-of-flight frame.
    moved : callable or None
        From a time after the frame's start in s to the scene at that time, of the same size; None: nothing moves.
    speed : float
        Of what moves, 0..1e7 px/s.
    notes : tuple of str
        What was changed for a sensor to see it, a line each.

    Raises
    ------
    ParameterError
        For a wrong shape or type, NaN, infinity or a value out of range.
    """

    name: str
    views: int
    field: npt.NDArray[np.floating] | None
    image: npt.NDArray[np.floating]
    disparity: npt.NDArray[np.floating] | None = None
    depth: npt.NDArray[np.floating] | None = None
    polarization: npt.NDArray[np.floating] | None = None
    specular: npt.NDArray[np.bool_] | None = None
    behind: npt.NDArray[np.floating] | None = None
    surfaces: npt.NDArray[np.floating] | None = None
    echo: Echo | None = None
    render: Callable[[Bools], View] | Kept | None = None
    static: bool = True
    moved: Callable[[float], "Scene"] | None = None
    speed: float = 0.0
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_int("views", self.views, 1, 31)
        if self.field is not None:
            self._check_field(self.field)
        elif not callable(self.render):
            raise ParameterError("light_field = None: must be an array, or there must be a function that renders it")
        check_choice("image dtype", str(self.image.dtype), DTYPES)
        for name, low, high, shape in (
            ("image", 0, RADIANCE_MAX, self.shape),
            ("disparity", -1e4, 1e4, self.shape),
            ("depth", 1e-3, FOCUS_MAX, self.shape),
            ("specular", 0, 1, self.shape),
            ("behind", 1e-3, FOCUS_MAX, self.shape),
            ("polarization", -1, 1, (2, *self.shape)),
            ("surfaces", -1e4, 1e4, (self.views, self.views, *self.shape)),
        ):
            value = getattr(self, name)
            if value is None:
                continue
            if value.shape not in (
                shape,
                (2, self.views, self.views, *self.shape) if name == "polarization" else shape,
            ):
                raise ParameterError(f"{name} shape = {value.shape}: must be {shape}")
            check_values(name, value, low, high)
        if self.echo is not None and self.echo.share.shape != (self.views, self.views, *self.shape):
            raise ParameterError(f"echo shape = {self.echo.share.shape}: must be that of the light field")
        check_real("speed", self.speed, 0, SPEED_MAX)
        if self.polarization is not None:
            check_values("degree of polarization", np.hypot(*self.polarization), 0, 1 + 1e-6)

    def _check_field(self, field: npt.NDArray[np.floating]) -> None:
        check_choice("light_field dtype", str(field.dtype), DTYPES)
        if field.ndim != 4 or field.shape[:2] not in ((self.views, self.views), (1, 1)) or 0 in field.shape:
            raise ParameterError(
                f"light_field shape = {field.shape}: must be (views, views, rows, cols) or "
                f"(1, 1, rows, cols) with views = {self.views}"
            )
        check_values("light_field", field, 0, RADIANCE_MAX)

    def __getstate__(self) -> dict[str, Any]:
        """Return the state to copy: the light field instead of the functions that render it."""
        state = {item.name: getattr(self, item.name) for item in fields(self)}
        if self.render is not None:
            state |= {"field": self.light_field, "render": Kept(), "moved": None}
        return state

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, cols = self.image.shape if self.field is None else self.field.shape[2:]
        return rows, cols

    @cached_property
    def light_field(self) -> npt.NDArray[np.floating]:
        """The light field, (views, views, rows, cols), or (1, 1, rows, cols) where all views are equal."""
        if self.field is not None:
            return self.field
        see, steps = self.view(np.ones(self.shape, bool)), np.arange(self.views) - (self.views - 1) / 2
        field = np.empty((self.views, self.views, *self.shape), self.image.dtype)
        for (v, dv), (u, du) in product(enumerate(steps), enumerate(steps)):
            field[v, u] = see(dv, du)[0]
        return field

    @property
    def seen_polarization(self) -> npt.NDArray[np.floating]:
        """S1/S0 and S2/S0 of the centre view, (2, rows, cols); 0 where the light is not polarized."""
        if self.polarization is None:
            return np.zeros((2, *self.shape))
        return self.polarization[(slice(None), *(self.views // 2,) * (self.polarization.ndim - 3))]

    @property
    def angular(self) -> bool:
        """Return whether the views may differ."""
        return self.field is None or self.field.shape[:2] != (1, 1)

    def view(self, mask: Bools) -> View:
        """Any view of the scene at some pixels.

        mask: bool (rows, cols), pixels to compute; the others are undefined. Returns View: a view of the light field
        itself where the scene has no others.
        """
        if callable(self.render):
            return self.render(mask)
        middle = (len(self.light_field) - 1) / 2
        disparity = np.zeros(self.shape) if self.disparity is None else self.disparity

        def _nearest(dv: float, du: float) -> tuple[npt.NDArray[np.floating], npt.NDArray[np.floating]]:
            place = round(dv + middle), round(du + middle)
            return self.light_field[place], disparity if self.surfaces is None else self.surfaces[place]

        return _nearest

    @property
    def full_light_field(self) -> npt.NDArray[np.floating]:
        """Light field with all views, (views, views, rows, cols): read-only, no copies."""
        return np.broadcast_to(self.light_field, (self.views, self.views, *self.shape))


def check_values(field: str, values: npt.NDArray[Any], low: float, high: float) -> None:
    """Check that every element of an array is finite and in a range.

    field: name in the message. values: array, checked values. low, high: allowed range, both ends included. Raises
    ParameterError for any other element.
    """
    # min and max propagate NaN, so that two passes are enough.
    smallest, largest = float(np.min(values)), float(np.max(values))
    if not (low <= smallest and largest <= high):
        worst = smallest if not low <= smallest else largest
        raise ParameterError(f"{field} = {worst:g}: every value must be a finite number in [{low:g}, {high:g}]")
