"""Pixels of a decoded picture, whatever its form: gray or colour, codes or linear light, on white."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from PIL import Image

LOW_BYTE = {"RGB;16B": "RGB;16L", "RGBA;16B": "RGBA;16L", "RGB;16L": "RGB;16B", "RGBA;16L": "RGBA;16B"}
LOW_BYTE |= {"RGB;16N": "RGB;16B", "RGBA;16N": "RGBA;16B"}  # of libtiff, native: little-endian here


class Pixels(NamedTuple):
    """A picture.

    Attributes
    ----------
    values : uint8, uint16 or float (height, width) or (height, width, 3)
        Gray or RGB, sRGB codes or linear light.
    white : float
        Code of white, 1..65535 of integers; 1 of floating point, which is linear.
    """

    values: npt.NDArray[Any]
    white: float

    def scaled(self) -> npt.NDArray[Any]:
        """Codes of 8 or of 16 bits, or linear values.

        Returns uint8, uint16 or float32 (height, width) or (height, width, 3): 255 or 65535 is white, 1 of float32.
        """
        if self.values.dtype.kind == "f":
            return self.values.astype(np.float32)
        top, dtype = (255, np.uint8) if self.white <= 255 else (65535, np.uint16)
        if self.white == top:
            return self.values.astype(dtype, copy=False)
        return np.rint(self.values * (top / self.white)).astype(dtype)


def upright(values: npt.NDArray[Any], orientation: int) -> npt.NDArray[Any]:
    """Turn a picture as EXIF and TIFF say.

    values: (height, width, ...), as stored. orientation: 1..8; any other is 1. Returns array: a view, as it is seen.
    """
    if orientation in (5, 6, 7, 8):
        values = values.swapaxes(0, 1)
    if orientation in (3, 4, 7, 8):
        values = values[::-1]
    return values[:, ::-1] if orientation in (2, 3, 6, 7) else values


def over_white(
    values: npt.NDArray[Any], alpha: npt.NDArray[np.floating], white: float, associated: bool = False
) -> npt.NDArray[Any]:
    """Lay a transparent picture on white.

    values: (height, width) or (height, width, 3), codes or linear values. alpha: float array (height, width), 0..1, 1
    is opaque. white: value of white. associated: whether ``values`` are multiplied by alpha. Returns array: of the
    values' shape and type.
    """
    alpha = alpha.reshape(alpha.shape + (1,) * (values.ndim - 2))
    mixed = (values if associated else values * alpha) + (1 - alpha) * white
    return (
        mixed.astype(values.dtype) if values.dtype.kind == "f" else np.rint(mixed.clip(0, white)).astype(values.dtype)
    )


def deep_pixels(opened: Callable[[], Image.Image]) -> Pixels | None:
    """Read colours, or gray with alpha, of 16 bits, of which Pillow keeps the upper 8: its decoder runs twice.

    opened: gives the picture, PNG or TIFF, not loaded. Returns Pixels or None: of uint16, turned as Pillow's; None of
    another picture.
    """
    with opened() as picture:
        mode = _rawmode(picture)
        clear = picture.info.get("transparency")
    if mode == "LA;16B":
        gray_high, gray_low, high, low = np.moveaxis(_decoded(opened, "RGBA"), 2, 0)
        gray, alpha = gray_high * np.uint16(256) + gray_low, high * np.uint16(256) + low
        return Pixels(over_white(gray, alpha / 65535, 65535), 65535)
    if mode not in LOW_BYTE:
        return None
    codes = _decoded(opened, mode) * np.uint16(256) + _decoded(opened, LOW_BYTE[mode])
    colours = codes[..., :3]
    if codes.shape[2] == 4:
        colours = over_white(colours, codes[..., 3] / 65535, 65535)
    elif clear is not None:
        colours = np.where((colours == clear).all(2, keepdims=True), np.uint16(65535), colours)
    return Pixels(colours, 65535)


def _rawmode(picture: Image.Image) -> str:
    """Return the layout of the first tile's bytes, '' where it is unknown."""
    tile = getattr(picture, "tile", None)
    args = tile[0].args if tile else ""
    first = args[0] if isinstance(args, tuple) and args else args
    return first if isinstance(first, str) else ""


def _decoded(opened: Callable[[], Image.Image], rawmode: str) -> npt.NDArray[np.uint8]:
    with opened() as picture:
        tiles: Any = picture
        args = tiles.tile[0].args
        args = (rawmode, *args[1:]) if isinstance(args, tuple) else rawmode
        tiles.tile = [tile._replace(args=args) for tile in tiles.tile]
        picture.load()
        return np.asarray(picture)


def image_pixels(picture: Image.Image, white: float = 255) -> Pixels:
    """Pixels of a picture that Pillow has decoded.

    picture: loaded; what it says of transparency is of `rawmode`'s codes. white: largest code of the file's gray, to
    which ``transparency`` belongs. Returns Pixels: as Pillow has turned them; integers of 32 bits are not checked.
    """
    clear = picture.info.get("transparency")
    if picture.mode == "F":
        return Pixels(np.asarray(picture), 1.0)
    if picture.mode.startswith("I"):
        codes = np.asarray(picture)
        return Pixels(codes if clear is None else np.where(codes == clear, codes.dtype.type(65535), codes), 65535.0)
    if picture.mode in ("1", "L"):
        codes = np.asarray(picture.convert("L"))
        if isinstance(clear, int):
            codes = np.where(codes == round(clear * 255 / white), np.uint8(255), codes)
        return Pixels(codes, 255.0)
    if "A" in picture.mode or "a" in picture.mode or clear is not None:
        picture = picture.convert("RGBA")
        page = Image.new("RGBA", picture.size, (255, 255, 255, 255))
        picture = Image.alpha_composite(page, picture)
    return Pixels(np.asarray(picture.convert("RGB")), 255.0)
