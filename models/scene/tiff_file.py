"""TIFF of every kind: bits per sample, photometric, alpha, planes, pages. What is none of a picture is refused by name.

tifffile reads tags and samples; what is compressed in a way that it leaves to the package imagecodecs is decoded by
Pillow's libtiff.
"""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image, UnidentifiedImageError
from tifffile import TiffFile, TiffPage

from talbot.models.parameters import ParameterError
from talbot.models.scene.file_form import DEVELOP
from talbot.models.scene.pixels import Pixels, deep_pixels, image_pixels, over_white, upright

logging.getLogger("tifffile").addHandler(logging.NullHandler())  # what is odd but read is no concern of ours
REDUCED = 1 | 4  # subfile types of thumbnails and masks
DNG_VERSION = 50706
GRAY, RGB, PALETTE, CMYK, YCBCR = (0, 1), 2, 3, 5, 6
RAW = 32803, 34892  # colour filter array, linear raw
COLOURS = {0: 1, 1: 1, RGB: 3, PALETTE: 1, CMYK: 4, YCBCR: 3}


@contextmanager
def tiff_pages(path: Path, field: str) -> Iterator[list[tuple[int, TiffPage]]]:
    """Pages of a TIFF that are pictures: no thumbnails, no masks.

    path: the file. field: name in the messages. Yields list of (int, TiffPage): number in the file and page, one or
    more. Raises ParameterError for a raw photograph, and a stack in one directory (ImageJ's of more than 4 GiB).
    """
    with TiffFile(path) as tiff:
        every: list[tuple[int, Any]] = list(enumerate(tiff.pages))
        if not every:
            raise ValueError("no page")
        if DNG_VERSION in every[0][1].tags or any(_tag(page, 262) in RAW for _, page in every):
            raise ParameterError(f"{field} = {str(path)!r}: is {DEVELOP.format(_camera_form(path))}")
        pages = [(i, page) for i, page in every if not int(page.subfiletype) & REDUCED] or every[:1]
        images = int((tiff.imagej_metadata or {}).get("images", 1))
        if len(pages) == 1 and images > 1 or pages[0][1].imagedepth > 1:
            raise ParameterError(f"{field} = {str(path)!r}: is a volume in one page: must be one picture, or pages")
        yield pages


def tiff_shape(page: TiffPage) -> tuple[int, int]:
    """Height and width of a page as it is seen.

    page: the page. Returns (int, int): in px.
    """
    height, width = page.imagelength, page.imagewidth
    return (width, height) if tiff_orientation(page) in (5, 6, 7, 8) else (height, width)


def tiff_orientation(page: TiffPage) -> int:
    """Return the orientation of a page.

    page: the page. Returns int: 1..8.
    """
    return int(_tag(page, 274, 1))


def tiff_pixels(path: Path, field: str, number: int, page: TiffPage) -> Pixels:
    """Read a page.

    path: the file. field: name in the messages. number: of the page in the file. page: the page. Returns Pixels:
    upright, on white. Raises ParameterError for a kind that is not read.
    """
    _check(path, field, page)
    if page.photometric == YCBCR:
        return _by_pillow(path, field, number, page)
    samples = _samples(path, field, page)
    if samples is None:
        return _by_pillow(path, field, number, page)
    if int(page.planarconfig) == 2 and samples.ndim == 3:
        samples = np.moveaxis(samples, 0, 2)
    samples, white = _unsigned(samples, path, field, page)
    photometric = int(page.photometric)
    count = COLOURS[photometric]
    colours = samples[..., 0] if samples.ndim == 3 and count == 1 else samples[..., :count] if count > 1 else samples
    if photometric == PALETTE:
        table = np.asarray(page.colormap)
        colours, white = np.moveaxis(table[:, colours], 0, -1), 65535.0 if table.max() > 255 else 255.0
    elif photometric == 0:
        colours = white - colours if white == 1 else int(white) - colours
    elif photometric == CMYK:
        light = 1 - colours.astype(np.float32) / white
        colours = light[..., :3] * light[..., 3:] * white
        colours = colours if white == 1 else np.rint(colours).astype(samples.dtype)
    extra = [int(kind) for kind in page.extrasamples]
    if samples.ndim == 3 and samples.shape[2] > count and (not extra or extra[0] in (1, 2)):
        alpha = samples[..., count] / (1.0 if photometric == PALETTE and white == 1 else _white(samples, page))
        colours = over_white(colours, alpha, white, associated=bool(extra) and extra[0] == 1)
    return Pixels(upright(colours, tiff_orientation(page)), white)


def _check(path: Path, field: str, page: TiffPage) -> None:
    """Refuse files that are no gray or colour picture, by name."""
    photometric, kind = int(page.photometric), int(page.sampleformat)
    bits = page.bitspersample
    extra = page.samplesperpixel - COLOURS.get(photometric, 0)
    name = getattr(page.photometric, "name", photometric)
    if photometric not in COLOURS:
        what = f"photometric interpretation {name}: must be gray, RGB, palette, CMYK or YCbCr"
    elif kind not in (1, 2, 3, 4):
        what = "complex samples: must be real"
    elif not isinstance(bits, int) or kind == 3 and bits not in (16, 32, 64) or bits > 64:
        what = f"bits per sample {bits}: must be 1..64, the same in all, floating-point 16, 32 or 64"
    elif extra not in (0, 1) or extra and photometric in GRAY and tuple(map(int, page.extrasamples)) == (0,):
        count = COLOURS[photometric]
        what = f"samples per pixel {count + extra}: must be {count} in {name}, and alpha"
    elif photometric == CMYK and _tag(page, 332, 1) != 1:
        what = "inks that are not CMYK: must be gray, RGB or CMYK"
    else:
        return
    raise ParameterError(f"{field} = {str(path)!r}: {what}")


def _samples(path: Path, field: str, page: TiffPage) -> npt.NDArray[Any] | None:
    """Return the samples as stored; None where Pillow must decode them."""
    bits = page.bitspersample
    if page.compression == 1 and bits not in (8, 16, 32, 64) and not page.is_tiled and page.planarconfig == 1:
        return _packed(page)
    if page.compression in (2, 3, 4, 6, 7):  # of faxes, JPEG
        return None
    try:
        return page.asarray()
    except (NotImplementedError, ValueError, KeyError, ImportError) as error:
        if "imagecodecs" not in str(error):
            raise
    plain = bits <= 8 or int(page.photometric) in (*GRAY, RGB) and 1 not in page.extrasamples and page.planarconfig == 1
    if int(page.sampleformat) != 1 or bits not in (1, 2, 4, 8, 16) or not plain:
        raise _needs_codecs(path, field, page)
    return None


def _packed(page: TiffPage) -> npt.NDArray[Any]:
    """Samples of any number of bits, without compression: each row begins with a byte."""
    bits, each, width = int(page.bitspersample), page.samplesperpixel, page.imagewidth
    stride = (width * each * bits + 7) // 8
    file = page.parent.filehandle
    parts = []
    for offset, count in zip(page.dataoffsets, page.databytecounts, strict=True):
        file.seek(offset)
        parts.append(np.frombuffer(file.read(count), np.uint8))
    data = np.concatenate(parts)
    if len(data) < stride * page.imagelength:
        raise ValueError("strips are too short")
    rows = data[: stride * page.imagelength].reshape(page.imagelength, stride)
    order = "little" if _tag(page, 266, 1) == 2 else "big"
    out = np.empty((page.imagelength, width * each), np.uint8 if bits < 8 else np.uint16 if bits < 16 else np.uint64)
    for y, row in enumerate(rows):
        split = np.unpackbits(row, bitorder=order)[: width * each * bits].reshape(-1, bits)
        out[y] = split @ (1 << np.arange(bits - 1, -1, -1, dtype=np.uint64))
    return out if each == 1 else out.reshape(page.imagelength, width, each)


def _unsigned(samples: npt.NDArray[Any], path: Path, field: str, page: TiffPage) -> tuple[npt.NDArray[Any], float]:
    """Samples and the one of white: integers of 8 or 16 bits, or float32."""
    if samples.dtype.kind == "f":
        return samples, 1.0
    samples = samples.astype(samples.dtype.newbyteorder("="), copy=False)
    white = _white(samples, page)
    if samples.dtype.kind == "b":
        samples = samples.view(np.uint8)
    if samples.dtype.kind == "i" and samples.min() < 0 or samples.max() > white:
        raise ParameterError(
            f"{field} = {str(path)!r}: {samples.dtype.name} pixels {samples.min()}..{samples.max()}: "
            f"must be in 0..{white:g}"
        )
    return samples.astype(np.uint8 if white <= 255 else np.uint16, copy=False), white


def _white(samples: npt.NDArray[Any], page: TiffPage) -> float:
    """Return the code of white: the largest of the bits, 65535 above 16 bits, 1 for floating point."""
    if int(page.sampleformat) == 3:
        return 1.0
    bits = min(int(page.bitspersample), 17) - (int(page.sampleformat) == 2)
    return float((1 << min(bits, 16)) - 1)


def _needs_codecs(path: Path, field: str, page: TiffPage) -> ParameterError:
    form = getattr(page.compression, "name", page.compression)
    return ParameterError(
        f"{field} = {str(path)!r}: {page.bitspersample} bits compressed as {form}: "
        "needs the package imagecodecs: pip install imagecodecs"
    )


def _by_pillow(path: Path, field: str, number: int, page: TiffPage) -> Pixels:
    """Decode by libtiff. Pillow turns a TIFF upright itself."""

    def opened() -> Image.Image:
        try:
            picture = Image.open(path, formats=["TIFF"])
            picture.seek(number)
        except UnidentifiedImageError:
            raise _needs_codecs(path, field, page) from None
        return picture

    if (deep := deep_pixels(opened)) is not None:
        return deep
    with opened() as picture:
        tags: Any = picture
        inverted = tags.tag_v2.get(262) == 0 and picture.mode.startswith("I")
        picture.load()
        values, white = image_pixels(picture)
        return Pixels((65535 - values if inverted else values).astype(values.dtype), white)


def _tag(page: Any, number: int, default: Any = None) -> Any:
    tag = page.tags.get(number)
    return default if tag is None else tag.value


def _camera_form(path: Path) -> str:
    suffix = path.suffix[1:].upper()
    return suffix if suffix and suffix not in ("TIF", "TIFF") else "DNG"
