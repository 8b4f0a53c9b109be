"""Light fields of one's own."""

from contextlib import ExitStack
from pathlib import Path
from typing import Self

import numpy as np

from talbot.base.files import atomic, check_file, staged
from talbot.flow.frame import pictures
from talbot.models import scene

from .image import png


class LightField(scene.LightField):
    """A light field l[v, u, y, x] or l[v, u, y, x, rgb]: what stands before the sensor, or an estimate of it.

    values: (views, views, height, width) or (views, views, height, width, 3), 1..31 views each way; view (v, u) is
    seen from row v, from above, and column u, from the left, of the pupil. uint8 and uint16 are sRGB codes, float16 to
    float64 linear radiance 0..16, where 1 is diffuse white. The sensor sees luminance, of the largest centred part
    with its proportions, reduced or enlarged to its pixels.

    disparity: (height, width) or None, of the middle view in its pixels per view step, -1e4..1e4, positive towards the
    camera: view (v, u) shows at (y, x) what the middle one shows at (y + dv d, x + du d). An image is rebuilt from
    edges with it.

    Raises ParameterError for any other array.
    """

    @classmethod
    def load(cls, path: str | Path, views: int | None = None) -> Self:
        """The light field in a file or folder.

        path: x.npy; x.npz with the array `light_field` (or one alone) and perhaps `disparity`; a folder with
        input_Cam000.png ... (HCI 4D; gt_disp_lowres.pfm is its disparity) or out_RR_CC_*.png (Stanford); or one image
        of tiles. views: along each axis, 1..31, of such an image alone. Raises ParameterError.
        """
        found = scene.read_light_field(path, views)
        return cls(found.values, found.disparity, found.name)

    def save(self, path: str | Path) -> None:
        """Write it in the form of the name: x.npy, x.npz, an image of tiles (x.png), or a folder of views as HCI's.

        Pictures take codes as they are; radiance, at most 1, becomes sRGB codes, gray of 16 bits, colours of 8. Raises
        ParameterError, OSError.
        """
        path = Path(path)
        with ExitStack() as stack:
            if path.suffix:
                check_file("path", path)
                part = stack.enter_context(atomic(path))
            else:
                old = [entry.name for entry in path.glob("input_Cam*")] if path.is_dir() else []
                part = stack.enter_context(staged(path, [*old, scene.light_field_file.DISPARITY]))
            scene.write_light_field(self, part)

    def __repr__(self) -> str:
        return f"<LightField {self.name}: {self.values.dtype} {self.values.shape}>"

    def _repr_png_(self) -> bytes:
        views = np.stack([[self.view(v, u) for u in range(self.views)] for v in range(self.views)])
        return png(pictures.view_sheet(views))
