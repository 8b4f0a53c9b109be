"""Light fields: arrays, files and estimates, with refocusing and disparity."""

import math
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from talbot.api.image import Image, png
from talbot.base.files import atomic, check_file, staged
from talbot.base.progress import say
from talbot.imaging.frame import pictures
from talbot.imaging.frame.light_field import SURE
from talbot.models import reconstruct, scene
from talbot.models.parameters import ParameterError, check_int, check_real
from talbot.models.scene.echo import Echo
from talbot.models.scene.light_field_file import DISPARITY

NEAR, FAR = 2.5, -2.5  # px per view step: as `make lightfield` tries them
MOST = 2000  # disparities that are tried
WIDEST = 100.0  # px per view step


class Disparity(Image):
    """A disparity for every pixel, float64 (rows, cols), px per view step, positive towards the camera.

    sure: bool (rows, cols), where its standard deviation is at most 0.5 px per view step.
    """

    sure: npt.NDArray[np.bool_]


class LightField:
    """A light field l[v, u, y, x] or l[v, u, y, x, rgb]: the scene of a sensor, or an estimate of it.

        field = talbot.LightField(views)  # or talbot.LightField.load("views/")
        near = field.refocus(1.0)  # what has 1 px per view step is sharp
        field.disparity(), field.all_in_focus()

    values: (view rows, view cols, height, width), perhaps with 3 colours behind; view (v, u) is seen from row v, from
    above, and column u, from the left, of the pupil. uint8 and uint16 are sRGB codes, float16 to float64 linear
    radiance -16..16, where 1 is diffuse white. The sensor sees luminance, 0 where it is below, of the largest centred
    part with its proportions, reduced or enlarged to its pixels; it takes as many views down as across, 1..31.

    disparity: (height, width) or None, of the middle view in its pixels per view step, -1e4..1e4, positive towards the
    camera: view (v, u) shows at (y, x) what the middle one shows at (y + dv d, x + du d). An image is rebuilt from
    edges with it. name: in reports. stokes, depth, specular, behind, echo: models/scene/light_field.py.

    Raises ParameterError for any other array.
    """

    def __init__(
        self,
        values: npt.ArrayLike,
        disparity: npt.ArrayLike | None = None,
        name: str = "light_field",
        stokes: npt.ArrayLike | None = None,
        depth: npt.ArrayLike | None = None,
        specular: npt.ArrayLike | None = None,
        behind: npt.ArrayLike | None = None,
        echo: Echo | None = None,
    ) -> None:
        maps: dict[str, Any] = {"stokes": stokes, "depth": depth, "specular": specular, "behind": behind}
        checked: Any = values, disparity
        self.data = scene.LightField(*checked, name=name, echo=echo, **maps)

    @classmethod
    def of(cls, data: scene.LightField) -> Self:
        """Return the light field of the models' data."""
        field = cls.__new__(cls)
        field.data = data
        return field

    @classmethod
    def load(cls, path: str | Path, views: int | tuple[int, int] | None = None) -> Self:
        """Return the light field in a file or folder.

        path: x.npy; x.npz with the array `light_field` (or one alone) and perhaps `disparity`, as lightfield.npz of
        `make lightfield`; a folder with input_Cam000.png ... (HCI 4D; gt_disp_lowres.pfm is its disparity) or
        out_RR_CC_*.png (Stanford); or one image of tiles, or of lenslets (x_eslf.png). views: along each axis, or
        rows and columns of them, 1..31, of an image alone. Raises ParameterError.
        """
        return cls.of(scene.read_light_field(path, views))

    def save(self, path: str | Path, white: float = 1.0) -> None:
        """Write it in the form of the name: x.npy, x.npz, an image of tiles (x.png), or a folder of views as HCI's.

        Arrays keep every value. Pictures take codes as they are; radiance of 0..white becomes sRGB codes, gray of 16
        bits, colours of 8, and what is beyond is clipped, which a line says. white: 0.001..16; what is read again is
        the radiance over it. Raises ParameterError, OSError.
        """
        path = Path(path)
        with ExitStack() as stack:
            if path.suffix:
                check_file("path", path)
                part = stack.enter_context(atomic(path))
            else:
                old = [entry.name for entry in path.glob("input_Cam*")] if path.is_dir() else []
                part = stack.enter_context(staged(path, [*old, DISPARITY]))
            clipped = scene.write_light_field(self.data, part, white)
        if clipped:
            say(f"{path}: {clipped}")

    @property
    def values(self) -> npt.NDArray[Any]:
        """The array that it is of."""
        return self.data.values

    @property
    def name(self) -> str:
        """Name in reports."""
        return self.data.name

    @property
    def views(self) -> int:
        """Views along each axis; of a rectangular grid, down."""
        return self.data.values.shape[0]

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width of a view."""
        return self.data.shape

    def view(self, v: int, u: int) -> Image:
        """Luminance of the view of row v and column u, linear, Image (height, width)."""
        return Image.of(self.data.view(v, u))

    def refocus(self, disparity: float) -> Image:
        """Return the picture of a lens that is focused where things have this disparity, Image (height, width).

        disparity: px per view step, -100..100, positive towards the camera. Mean of the views, each moved by its share,
        linear luminance; views without any light, as in a round pupil's corners, do not count. Raises ParameterError.
        """
        check_real("disparity", disparity, -WIDEST, WIDEST)
        return Image.of(reconstruct.refocus(self._light, disparity))

    def disparity(self, far: float = FAR, near: float = NEAR, disparities: int | None = None) -> Disparity:
        """Disparity of every pixel of the middle view, px per view step: a `Disparity`, which says where it is sure.

        Its own where it came with one; else that at which the views agree best, so that a light field of one view, or
        of uniform light, has none that is sure. far, near: ends of what is tried, -100..100. disparities: how many,
        3..2000; by default as many that the outermost views move by half a pixel from one to the next.
        Raises ParameterError.
        """
        check_real("far", far, -WIDEST, WIDEST)
        check_real("near", near, far, WIDEST)
        rows, cols = self.values.shape[:2]
        steps = math.ceil((near - far) * (max(rows, cols) - 1)) + 1
        steps = min(max(steps, 3), MOST) if disparities is None else disparities
        check_int("disparities", steps, 3, MOST)
        if self.data.disparity is not None:
            known = np.asarray(self.data.disparity, float).reshape(-1, *self.shape)
            return _disparity(known[len(known) // 2], np.ones(self.shape, bool))
        if rows * cols == 1 or near == far:
            return _disparity(np.full(self.shape, (near + far) / 2), np.zeros(self.shape, bool))
        value, spread = reconstruct.disparity_of(self._light, np.linspace(far, near, steps))
        return _disparity(value, spread <= SURE)

    def all_in_focus(self, disparity: npt.ArrayLike | None = None) -> Image:
        """The picture with every pixel refocused at its own disparity, Image (height, width): all of it is sharp.

        disparity: (height, width), px per view step; by default `disparity()`.
        Raises ParameterError.
        """
        chosen = np.asarray(self.disparity() if disparity is None else disparity, float)
        if chosen.shape != self.shape or not np.isfinite(chosen).all():
            raise ParameterError(f"disparity = array of shape {chosen.shape}: must be {self.shape}, finite everywhere")
        return Image.of(reconstruct.all_in_focus(self._light, chosen))

    @property
    def _light(self) -> npt.NDArray[np.float32]:
        """Linear luminance of every view, l[v, u, y, x]."""
        grid = self.values.shape[:2]
        light = np.empty((*grid, *self.shape), np.float32)
        for v, u in np.ndindex(grid):
            light[v, u] = self.data.view(v, u)
        return light

    def __repr__(self) -> str:
        return f"<LightField {self.name}: {self.values.dtype} {self.values.shape}>"

    def _repr_png_(self) -> bytes:
        return png(pictures.view_sheet(self._light))


def _disparity(values: npt.NDArray[Any], sure: npt.NDArray[np.bool_]) -> Disparity:
    out = Disparity.of(values).view(Disparity)
    out.sure = sure
    return out
