"""A picture through the codecs that a user would otherwise choose, in as many bytes as a stream has."""

import io
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from PIL import Image

Picture, Values = npt.NDArray[np.uint8], npt.NDArray[np.float64]
GAMMA = 2.2  # of the pictures that the codecs get
JPEGXL_EFFORT = 7  # libjxl's default


class Codec(NamedTuple):
    """A way to bytes and back. encode: takes a gray picture (rows, cols) and a quality of 1..100."""

    encode: Callable[[Picture, int], bytes]
    decode: Callable[[bytes], Picture]


def _pillow(kind: str, **options: Any) -> Codec:
    def encode(picture: Picture, quality: int) -> bytes:
        file = io.BytesIO()
        Image.fromarray(picture).save(file, kind, quality=quality, **options)
        return file.getvalue()

    return Codec(encode, lambda data: np.asarray(Image.open(io.BytesIO(data)).convert("L")))


def _jpegxl() -> Codec:
    def encode(picture: Picture, quality: int) -> bytes:
        import imagecodecs  # an extra

        return bytes(imagecodecs.jpegxl_encode(picture, level=quality, effort=JPEGXL_EFFORT))

    def decode(data: bytes) -> Picture:
        import imagecodecs

        return imagecodecs.jpegxl_decode(data)

    return Codec(encode, decode)


CODECS = {"jpeg": _pillow("JPEG"), "avif": _pillow("AVIF", speed=8), "jpegxl": _jpegxl()}


def absent(codec: str) -> str | None:
    """Why a codec of CODECS cannot be used here; None where it can."""
    if codec == "jpegxl" and not find_spec("imagecodecs"):
        return "imagecodecs is not installed: make setup, or pip install 'talbot[codecs]'"
    return None


def coded(image: Values, codec: str, size: int) -> Values | None:
    """Return an image (rows, cols) >= 0 through a codec, at its best quality of at most ``size`` bytes.

    None where even the worst is larger, and where the codec is `absent`.
    """
    if absent(codec):
        return None
    top = max(float(image.max()), 1e-9)
    picture = np.rint(255 * (image / top) ** (1 / GAMMA)).astype(np.uint8)
    encode, decode = CODECS[codec]
    best, low, high = None, 1, 100
    while low <= high:
        quality = (low + high) // 2
        data = encode(picture, quality)
        if len(data) <= size:
            best, low = data, quality + 1
        else:
            high = quality - 1
    return None if best is None else top * (decode(best) / 255.0) ** GAMMA
