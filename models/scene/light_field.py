"""A light field as data: an array [v, u, y, x] or [v, u, y, x, rgb] of one's own, seen by the sensor as a scene.

View (v, u) is the scene from the pupil's row v, from above, and column u, from the left: the sensor has as many views
as the light field; of a grid that is no square, the middle square.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import FOCUS_MAX, ParameterError, check_int
from talbot.models.scene import camera, resample
from talbot.models.scene.echo import Echo
from talbot.models.scene.picture_file import decode16
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import RADIANCE_MAX, Scene, check_values

CODES = ("uint8", "uint16")
FLOATS = ("float16", "float32", "float64")
SIZE_MAX = 1024, 1536  # rows and columns of a sensor
REC709 = np.array([0.2126, 0.7152, 0.0722])


def native(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Change an array to this machine's byte order.

    values: array, of either order. Returns array: ``values`` itself where it has it.
    """
    return values if values.dtype.isnative else values.astype(values.dtype.newbyteorder("="))


@dataclass(frozen=True, eq=False)
class LightField:
    """A light field, checked when it is created.

    Attributes
    ----------
    values : array (rows of views, views a row, height, width) or (rows of views, views a row, height, width, 3)
        l[v, u, y, x], gray or RGB, 1..31 views each way, of either byte order. uint8 and uint16 are sRGB codes; float16
        to float64 is linear radiance, -16..16, 1 = diffuse white: an estimate may be below 0, a sensor sees 0 there.
    disparity : array (height, width) or (views, views, height, width), or None
        Of the middle view, or of what every view shows, in pixels per view step, -1e4..1e4, positive towards the
        camera: view (v, u) shows at (y, x) what the middle one shows at (y + dv d, x + du d). Without it no image is
        rebuilt from edges.
    name : str
        Name in reports.
    stokes : array (2, views, views, height, width) or (2, height, width), or None
        S1 and S2 of every view or of all alike, in the unit of ``values`` as linear radiance; None is unpolarized.
    depth : array (height, width) or None
        Of the middle view in m of the scene, 0.001..1000; for time of flight.
    specular : bool (height, width) or None
        Where the middle view shows a specular reflection, if that is known.
    behind : array (height, width) or None
        Depth of the surface behind an occluder, in m of the scene, 0.001..1000.
    echo : Echo or None
        Where the light of time of flight has been; of an array of the light field's size alone.

    Raises
    ------
    ParameterError
        For a wrong shape or type, NaN, infinity or a value out of range.
    """

    values: npt.NDArray[Any]
    disparity: npt.NDArray[Any] | None = None
    name: str = "light_field"
    stokes: npt.NDArray[Any] | None = None
    depth: npt.NDArray[Any] | None = None
    specular: npt.NDArray[Any] | None = None
    behind: npt.NDArray[Any] | None = None
    echo: Echo | None = None

    def __post_init__(self) -> None:
        if np.ma.is_masked(self.values):
            raise ParameterError("light field = a masked array: must have a value everywhere")
        try:
            values = native(np.asarray(self.values))
        except ValueError as error:  # a list of lists of other lengths
            raise ParameterError(f"light field = no array: must be (views, views, height, width) ({error})") from None
        object.__setattr__(self, "values", values)
        shape = values.shape
        if len(shape) not in (4, 5) or 0 in shape or shape[4:] not in ((), (3,)):
            raise ParameterError(
                f"light field = array of shape {shape}: must be (views, views, height, width), or with 3 colours behind"
            )
        for count in shape[:2]:
            check_int("views", count, 1, 31)
        if values.dtype.name not in CODES + FLOATS:
            codes = "; integers are codes, .astype('uint8') where white is 255" if values.dtype.kind in "iu" else ""
            raise ParameterError(f"light field = {values.dtype} array: must be of {', '.join(CODES + FLOATS)}{codes}")
        if values.dtype.name in FLOATS:
            check_values("light field", values, -RADIANCE_MAX, RADIANCE_MAX)
        single, every = shape[2:4], shape[:4]
        for name, low, high, shapes in (
            ("disparity", -1e4, 1e4, (single, every)),
            ("depth", 1e-3, FOCUS_MAX, (single,)),
            ("specular", 0, 1, (single,)),
            ("behind", 1e-3, FOCUS_MAX, (single,)),
            ("stokes", -RADIANCE_MAX, RADIANCE_MAX, ((2, *every), (2, *single))),
        ):
            if getattr(self, name) is not None:
                array = native(np.asarray(getattr(self, name)))
                object.__setattr__(self, name, array)
                if array.shape not in shapes or array.dtype.kind not in "biuf":
                    must = " or ".join(map(str, shapes))
                    raise ParameterError(
                        f"{name} = {array.dtype} array of shape {array.shape}: must be numbers, {must}"
                    )
                check_values(name, array, low, high)
        if self.echo is not None and self.echo.share.shape != every:
            raise ParameterError(f"echo = shares of shape {self.echo.share.shape}: must be {every}")

    @property
    def grid(self) -> tuple[int, int]:
        """Rows of views, and views in a row."""
        return self.values.shape[0], self.values.shape[1]

    @property
    def views(self) -> int:
        """Views along each axis; of a grid that is no square, of its middle square."""
        return min(self.grid)

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width of a view."""
        return self.values.shape[2], self.values.shape[3]

    def view(self, v: int, u: int) -> npt.NDArray[np.float64]:
        """Radiance of a view.

        v, u: its row and column. Returns (height, width): linear luminance, -16..16.
        """
        codes = self.values[v, u]
        if codes.dtype == np.uint8:
            return resample.linear(codes).astype(float)
        light = decode16(codes / 65535) if codes.dtype == np.uint16 else codes.astype(float)
        return light @ REC709 if light.ndim == 3 else light

    def scene(self, sampling: Sampling) -> Scene:
        """Return the light field before a sensor.

        sampling: array; its number of views is not used. Returns Scene: of the array's size: the largest centred part
        with its proportions. Light below 0 is 0, which a note says.
        """
        if self.grid != (self.views, self.views):
            return self.squared().scene(sampling)
        size, middle = sampling.shape, self.views // 2
        box = resample.centre_box(*self.shape, *size)
        same = self.shape == size
        field = np.empty((self.views, self.views, *size), sampling.dtype)
        for v, u in np.ndindex(self.views, self.views):
            light = np.maximum(self.view(v, u), 0)
            # Means may round past the ends
            field[v, u] = light if same else np.clip(resample.resize(light, *size, box), 0, RADIANCE_MAX)
        disparity = surfaces = None
        if self.disparity is not None:
            zoom = sampling.cols / (box[2] - box[0])
            parts = np.reshape(self.disparity, (-1, *self.shape))
            views = np.array([np.clip(resample.pick(part, *size, box) * zoom, -1e4, 1e4) for part in parts])
            disparity = views[len(views) // 2]
            surfaces = views.reshape(self.views, self.views, *size) if len(views) > 1 else None
        image = field[middle, middle].copy()
        polarization = None if self.stokes is None else self._polarization(field, box)
        depth, specular, behind = (
            None if p is None else resample.pick(p, *size, box) for p in (self.depth, self.specular, self.behind)
        )
        if (field == image).all() and (polarization is None or polarization.ndim == 3):
            field = field[:1, :1]
        return Scene(
            self.name,
            self.views,
            field,
            image,
            disparity,
            None if depth is None else camera.scaled(depth, sampling.camera),
            polarization,
            None if specular is None else specular > 0.5,
            None if behind is None else camera.scaled(behind, sampling.camera),
            surfaces if len(field) > 1 else None,
            self.echo if same else None,
            notes=self._below_zero(),
        )

    def _below_zero(self) -> tuple[str, ...]:
        """Return a line on the negative light, which the sensor does not see."""
        least = float(self.values.min())
        if least >= 0:
            return ()
        share = float((self.values < 0).mean())
        return (f"{self.name}: {100 * share:.2g} % of the light field is below 0, to {least:.3g}: clipped to 0",)

    def squared(self) -> "LightField":
        """Return the middle square of the views.

        Returns LightField: of `views` x `views`; its middle view is the grid's.
        """
        top, left = (count // 2 - self.views // 2 for count in self.grid)
        part = np.s_[..., top : top + self.views, left : left + self.views, :, :]
        stokes, disparity = self.stokes, self.disparity
        return LightField(
            self.values[top : top + self.views, left : left + self.views],
            disparity if disparity is None or disparity.ndim == 2 else disparity[part],
            self.name,
            stokes if stokes is None or stokes.ndim == 3 else stokes[part],
            self.depth,
            self.specular,
            self.behind,
            None if self.echo is None else replace(self.echo, share=self.echo.share[part]),
        )

    def own_size(self) -> tuple[int, int]:
        """Rows and columns of a sensor that sees it pixel for pixel.

        Returns (int, int): those of a view; reduced to `SIZE_MAX` with its proportions where it is larger.
        """
        factor = max(1.0, *(size / most for size, most in zip(self.shape, SIZE_MAX, strict=True)))
        rows, cols = (max(1, int(size / factor)) for size in self.shape)
        return rows, cols

    def cropped(self, rows: int, cols: int) -> "LightField":
        """Return the middle of the picture.

        rows, cols: at most height and width. Returns LightField: of this size, pixel for pixel.
        """
        top, left = (2 * ((array - n) // 4) for array, n in zip(self.shape, (rows, cols), strict=True))
        part = np.s_[..., top : top + rows, left : left + cols]
        maps = {name: getattr(self, name) for name in ("disparity", "stokes", "depth", "specular", "behind")}
        return LightField(
            self.values[:, :, top : top + rows, left : left + cols],
            name=self.name,
            echo=None if self.echo is None else self.echo.cropped(top, left, rows, cols),
            **{name: None if array is None else array[part] for name, array in maps.items()},
        )

    def _polarization(
        self, field: npt.NDArray[np.floating], box: tuple[float, float, float, float]
    ) -> npt.NDArray[np.float64]:
        """S1/S0 and S2/S0 of every view of ``field``, or of all alike; 0 where there is no light."""
        stokes, rows, cols = np.asarray(self.stokes, float), *field.shape[2:]
        parameters = stokes.reshape(-1, *self.shape)
        scaled = (
            parameters
            if parameters.shape[1:] == (rows, cols)
            else [resample.resize(part, rows, cols, box) for part in parameters]
        )
        parts = np.reshape(scaled, (*stokes.shape[:-2], rows, cols))
        light = field if stokes.ndim == 5 else field[self.views // 2, self.views // 2]
        ratio = np.where(light > 0, parts / np.where(light > 0, light, 1), 0)
        return ratio / np.maximum(np.hypot(*ratio), 1)
