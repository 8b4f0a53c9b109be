"""Image files as linear luminance: 1 to 16 bits, gray, colour, palette or alpha, of any size."""

import re
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from PIL import Image, PngImagePlugin

from talbot.models.parameters import ParameterError
from talbot.models.scene.file_form import form_of
from talbot.models.scene.pixels import Pixels, deep_pixels, image_pixels, upright
from talbot.models.scene.resample import linear

PIXELS_MAX = 2 * 89_478_485  # Pillow's limit against decompression bombs
FORMATS = "PNG", "JPEG", "TIFF", "WEBP", "AVIF", "JPEG2000", "GIF", "BMP", "PPM"  # named to users, where built in
# Pillow opens these and decodes them with programs of others, not at all, or without their scale
NOT_READ = "BUFR", "EPS", "FITS", "GRIB", "HDF5", "IPTC", "MCIDAS", "MPEG", "PCD", "PSD", "WMF"
TIFF = b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"
FLOAT_MAX = float(np.finfo(np.float32).max)
ANIMATED = "GIF", "WEBP", "PNG", "AVIF"  # formats whose further pictures are frames, not pages or previews
GRAY = 0.05  # of white: colours of a gray picture differ by less, where its compression has changed them
KEEP = 3  # a picture this many times the array is reduced before it is decoded to linear light
REC709 = np.array([0.2126, 0.7152, 0.0722], np.float32)


class Header(NamedTuple):
    """A file's statements on its pictures, before decoding.

    Attributes
    ----------
    shape : (int, int)
        Height and width as seen, in px.
    frames : int
        Pictures of an animation, or pages of a TIFF.
    orientation : int
        EXIF's, 1..8.
    """

    shape: tuple[int, int]
    frames: int
    orientation: int


def read_luminance(path: str | Path, rows: int, cols: int) -> npt.NDArray[np.float32]:
    """Read the linear luminance of a picture.

    Codes are sRGB; floating-point pictures (TIFF) are linear. Transparency shows white.

    path: the image. rows, cols: size of the array. A much larger picture is reduced in whole boxes. Returns float32
    (height, width): 0..1. Raises ParameterError if the file is missing, no image, damaged, too large, of a kind that is
    not read, of more than one picture, or holds NaN or infinity.
    """
    return luminance_of(read_pixels(path, "scene", (rows, cols)), path, rows, cols)


def luminance_of(pixels: Pixels, path: str | Path, rows: int, cols: int) -> npt.NDArray[np.float32]:
    """Linear luminance of a picture.

    pixels: the picture. path: its file, for the messages. rows, cols: size of the array. A much larger picture is
    reduced in whole boxes. Returns float32 (height, width): 0..1. Raises ParameterError if it holds NaN, infinity or
    values out of range.
    """
    values, white = _checked(pixels, path)
    height, width = values.shape[:2]
    factor = max(1, min(height // (KEEP * rows), width // (KEEP * cols)))
    if white == 255:
        return linear(_reduced(values, factor))
    planes = [_reduced(plane.astype(np.float32), factor) for plane in np.moveaxis(np.atleast_3d(values), 2, 0)]
    light = [plane if values.dtype.kind == "f" else decode16(plane / white) for plane in planes]
    return np.asarray(light[0] if len(light) == 1 else np.tensordot(REC709, light, 1), np.float32)


def read_codes(path: str | Path, field: str) -> npt.NDArray[np.uint8] | npt.NDArray[np.uint16]:
    """Read the gray codes of a picture as stored, upright, for depth maps.

    path: the image. field: name in the messages. Returns uint8 or uint16 (height, width): codes; of fewer than 8 bits,
    as codes of 8. Raises ParameterError if the file is missing, no image, damaged, too large, a floating-point picture,
    or coloured.
    """
    pixels = read_pixels(path, field)
    if pixels.values.dtype.kind == "f":
        raise ParameterError(f"{field} = {str(path)!r}: a floating-point depth map must be .npy or .npz")
    values, white = _checked(pixels, path, field=field)
    if values.ndim == 3:
        gray = np.rint(values.mean(2)).astype(values.dtype)
        if np.abs(values.astype(float) - gray[..., None]).max() > GRAY * white:
            raise ParameterError(f"{field} = {str(path)!r}: colours: must be gray")
        values = gray
    return Pixels(values, white).scaled() if white <= 255 else values.astype(np.uint16)


def read_picture(path: str | Path, low: float = 0.0, high: float = 1.0) -> npt.NDArray[Any]:
    """Read a picture as stored, upright: gray or RGB codes, or linear values.

    path: the image. low, high: range of floating-point values. Returns uint8, uint16 or float32 (height, width) or
    (height, width, 3): transparency shows white. Raises ParameterError if the file is missing, no image, damaged, too
    large, of a kind that is not read, of more than one picture, or holds NaN or infinity.
    """
    return _checked(read_pixels(path, "scene"), path, low, high).scaled()


def header_of(path: str | Path, field: str) -> Header:
    """Read the header of an image file.

    path: the image. field: name in the messages. Returns Header: size and number of pictures. Raises ParameterError if
    the file is missing, no image, too large, or a form that is not read.
    """
    with _opened(path, field) as (picture, pages):
        if pages is not None:
            from talbot.models.scene.tiff_file import tiff_orientation, tiff_shape

            return Header(tiff_shape(pages[0][1]), len(pages), tiff_orientation(pages[0][1]))
        orientation = int(picture.getexif().get(274, 1))
        size = picture.size if orientation in (5, 6, 7, 8) else picture.size[::-1]
        return Header(size, _frames_of(picture), orientation)


def read_pixels(path: str | Path, field: str, size: tuple[int, int] | None = None) -> Pixels:
    """Read a file of one picture.

    path: the image. field: name in the messages. size: (int, int), rows and columns of the array, for which a JPEG is
    decoded at a fraction of its size. Returns Pixels: upright, on white. Raises ParameterError as `read_luminance`.
    """
    with _opened(path, field) as (picture, pages):
        count = len(pages) if pages is not None else _frames_of(picture)
        if count > 1:
            what = f"is a TIFF stack of {count} pages" if pages is not None else f"has {count} frames"
            hint = "; talbot sequence takes all" if field == "scene" else ""
            raise ParameterError(f"{field} = {str(path)!r}: {what}: must be one picture{hint}")
        if pages is not None:
            from talbot.models.scene.tiff_file import tiff_pixels

            return tiff_pixels(Path(path), field, *pages[0])
        if size:
            picture.draft("RGB", (KEEP * size[1], KEEP * size[0]))
        return _pixels(picture, Path(path), field)


def read_frames(path: str | Path, field: str) -> Iterator[tuple[Pixels, float]]:
    """Read all pictures of an animation or a TIFF stack.

    path: the image. field: name in the messages. Yields (Pixels, float): upright, on white, and how long it is shown in
    s; 0 where the file does not say. Raises ParameterError if it is damaged.
    """
    with _opened(path, field) as (picture, pages):
        for number in range(len(pages) if pages is not None else _frames_of(picture)):
            with _undamaged(field, path, f"frame {number}"):
                if pages is not None:
                    from talbot.models.scene.tiff_file import tiff_pixels

                    pixels, seconds = tiff_pixels(Path(path), field, *pages[number]), 0.0
                else:
                    picture.seek(number + _still(picture))
                    picture.load()
                    pixels, seconds = _upright(picture), float(picture.info.get("duration") or 0) / 1000
            yield pixels, seconds


@contextmanager
def _opened(path: str | Path, field: str) -> Iterator[tuple[Any, Any]]:
    """The picture of an image file that Pillow reads, its header read, or the pages of a TIFF."""
    path = Path(path)
    if path.is_dir():
        raise ParameterError(f"{field} = {str(path)!r}: must be an image file, not a folder")
    if not path.is_file():
        raise ParameterError(f"{field} = {str(path)!r}: no such file; must be a readable file")
    bomb = ParameterError(f"{field} = {str(path)!r}: must be an image of 1..{PIXELS_MAX} pixels")
    with ExitStack() as stack, _quiet():
        try:
            if form := form_of(path):
                raise ParameterError(f"{field} = {str(path)!r}: is {form}")
            with path.open("rb") as file:
                tiff = file.read(4) in TIFF
            if tiff:
                from talbot.models.scene.tiff_file import tiff_pages

                opened = None, stack.enter_context(tiff_pages(path, field))
                if any(not 0 < page.imagelength * page.imagewidth <= PIXELS_MAX for _, page in opened[1]):
                    raise bomb
            else:
                Image.init()
                read = [name for name in Image.OPEN if name not in NOT_READ]
                opened = stack.enter_context(Image.open(path, formats=read)), None
        except ParameterError:
            raise
        except Image.DecompressionBombError:
            raise bomb from None
        except Exception as error:
            Image.init()
            formats = ", ".join(name for name in FORMATS if name in Image.OPEN)
            raise ParameterError(
                f"{field} = {str(path)!r}: must be an image file of a form that is read, {formats} "
                f"({type(error).__name__})"
            ) from None
        with _undamaged(field, path):
            yield opened


def _pixels(picture: Image.Image, path: Path, field: str) -> Pixels:
    """Return a picture that Pillow reads, not loaded, upright, on white."""
    white, depth = 255.0, _bits(picture, path)
    if isinstance(picture, PngImagePlugin.PngImageFile):
        deep = deep_pixels(partial(Image.open, path, formats=["PNG"]))
        if deep is not None:
            picture.load()  # EXIF may stand behind the pixels
            return deep._replace(values=upright(deep.values, int(picture.getexif().get(274, 1))))
        white = {"L;2": 3.0, "L;4": 15.0}.get(str(picture.tile[0].args) if picture.tile else "", 255.0)
    elif depth > 8 and picture.mode not in ("I", "I;16", "F"):
        if picture.format == "PPM":
            return _ppm_pixels(picture, path)
        raise ParameterError(
            f"{field} = {str(path)!r}: {picture.format} of {depth} bits a colour: must have 8, or be PNG or TIFF"
        )
    picture.load()
    return _upright(picture, white)


def _upright(picture: Image.Image, white: float = 255.0) -> Pixels:
    pixels = image_pixels(picture, white)
    return pixels._replace(values=upright(pixels.values, int(picture.getexif().get(274, 1))))


def _bits(picture: Any, path: Path) -> int:
    """Bits of a colour, where a form may have more than 8 and Pillow does not say."""
    if picture.format == "PPM" and picture.tile:
        *_, top = args if isinstance(args := picture.tile[0].args, tuple) else (None,)
        return top.bit_length() if isinstance(top, int) else 8
    if picture.format == "SGI":
        return 8 * path.read_bytes()[3]
    if picture.format == "JPEG2000":
        with path.open("rb") as file:
            sizes = re.search(rb"(?s)\xff\x51.{38}(.)", file.read(1 << 16))
        return (sizes[1][0] & 127) + 1 if sizes else 8
    return 8


def _ppm_pixels(picture: Any, path: Path) -> Pixels:
    """Return a PPM of more than 8 bits, which Pillow reduces to 8."""
    tile, (width, height) = picture.tile[0], picture.size
    data = path.read_bytes()[tile.offset :]
    plain = tile.codec_name == "ppm_plain"
    codes = np.array(data.split(), np.uint16) if plain else np.frombuffer(data, ">u2").astype(np.uint16)
    return Pixels(codes[: 3 * width * height].reshape(height, width, 3), float(tile.args[-1]))


def _still(picture: Any) -> int:
    """Return the number of pictures before the frames: an APNG's default image may be one."""
    return int(getattr(picture, "default_image", False) and picture.n_frames > 1)


def _frames_of(picture: Any) -> int:
    if picture.format not in ANIMATED:
        return 1
    return int(getattr(picture, "n_frames", 1)) - _still(picture)


@contextmanager
def _quiet() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # up to PIXELS_MAX is allowed; odd metadata is no concern of ours
        yield


@contextmanager
def _undamaged(field: str, path: str | Path, part: str = "the image") -> Iterator[None]:
    """Decode within: a damaged file may raise nearly anything in a decoder."""
    try:
        yield
    except ParameterError:
        raise
    except Exception as error:
        raise ParameterError(f"{field} = {str(path)!r}: {part} is damaged ({error})") from None


def _checked(pixels: Pixels, path: str | Path, low: float = 0.0, high: float = 1.0, field: str = "scene") -> Pixels:
    """Return the values in range: integers as uint8 or uint16, floating point in ``low``..``high``."""
    values, white = pixels
    smallest, largest = float(values.min()), float(values.max())
    if values.dtype.kind != "f":
        if smallest < 0 or largest > 65535:
            raise ParameterError(f"{field} = {str(path)!r}: integer pixels must be in 0..65535")
        return Pixels(values.astype(np.uint8 if white <= 255 else np.uint16, copy=False), white)
    if not (smallest >= low and largest <= high):
        worst = largest if smallest >= low else smallest
        raise ParameterError(
            f"{field} = {str(path)!r}: pixel value {worst:g}: every floating-point pixel must be a "
            f"finite number in [{low:g}, {high:g}]"
        )
    return pixels


def _reduced(values: npt.NDArray[Any], factor: int) -> npt.NDArray[Any]:
    """Means over boxes of ``factor`` x ``factor`` codes."""
    return np.asarray(Image.fromarray(np.ascontiguousarray(values)).reduce(factor)) if factor > 1 else values


def decode16(unit: npt.NDArray[np.floating]) -> npt.NDArray[Any]:
    """Linear light of sRGB codes.

    unit: (...), codes over the largest one, 0..1. Returns (...): 0..1. [IEC61966-2-1].
    """
    return np.where(unit <= 0.04045, unit / 12.92, ((unit + 0.055) / 1.055) ** 2.4)


def encode16(light: npt.NDArray[np.floating]) -> npt.NDArray[Any]:
    """SRGB codes of linear light: the inverse of `decode16`.

    light: (...), 0..1. Returns (...): codes over the largest one, 0..1, not rounded. [IEC61966-2-1].
    """
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
