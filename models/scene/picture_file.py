"""From any image file to linear luminance: 8 or 16 bit, gray, colour, palette or alpha, of any size."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageOps, UnidentifiedImageError

from talbot.models.parameters import ParameterError

from .resample import linear

PIXELS_MAX = 2 * 89_478_485  # Pillow's limit against decompression bombs
FORMATS = "PNG", "JPEG", "TIFF", "WEBP", "AVIF", "JPEG2000", "GIF", "BMP", "PPM"  # named to users, where built in
FLOAT_MAX = float(np.finfo(np.float32).max)
ANIMATED = "GIF", "WEBP", "PNG", "AVIF"  # formats whose further pictures are frames, not pages or previews
KEEP = 3  # a picture this many times the array is reduced before it is decoded to linear light


def read_luminance(path: str | Path, rows: int, cols: int) -> npt.NDArray[np.float32]:
    """Read the linear luminance of a picture.

    8-bit and 16-bit codes are sRGB; floating-point pictures (TIFF) are linear. Transparency shows white.

    Parameters
    ----------
    path : path
        The image.
    rows, cols : int
        Size of the array. A much larger picture is reduced in whole boxes.

    Returns
    -------
    float32 (height, width)
        0..1.

    Raises
    ------
    ParameterError
        If the file is missing, no image, damaged, too large, or holds NaN or infinity.
    """
    with opened(path, "scene") as picture:
        if frames_of(picture, path) > 1:
            raise ParameterError(
                f"scene = {str(path)!r}: has {frames_of(picture, path)} frames: must be one picture; "
                "talbot sequence takes all"
            )
        picture.draft("RGB", (KEEP * cols, KEEP * rows))  # JPEG: decode at a fraction of the size
        return luminance_of(loaded(picture, path, "scene"), path, rows, cols)


def luminance_of(picture: Image.Image, path: str | Path, rows: int, cols: int) -> npt.NDArray[np.float32]:
    """Linear luminance of a picture.

    Parameters
    ----------
    picture : Image
        The picture, loaded.
    path : path
        Its file, for the messages.
    rows, cols : int
        Size of the array. A much larger picture is reduced in whole boxes.

    Returns
    -------
    float32 (height, width)
        0..1.

    Raises
    ------
    ParameterError
        If it holds NaN, infinity or values out of range.
    """
    picture = ImageOps.exif_transpose(picture)
    return _luminance(picture, path, max(1, min(picture.height // (KEEP * rows), picture.width // (KEEP * cols))))


def read_codes(path: str | Path, field: str) -> npt.NDArray[np.uint8] | npt.NDArray[np.uint16]:
    """Read the gray codes of a picture as stored, for depth maps.

    Parameters
    ----------
    path : path
        The image.
    field : str
        Name in the messages.

    Returns
    -------
    uint8 or uint16 (height, width)
        Codes.

    Raises
    ------
    ParameterError
        If the file is missing, no image, damaged, too large, or a floating-point picture.
    """
    with opened(path, field) as picture:
        picture = loaded(picture, path, field)
        if picture.mode.startswith("I"):
            codes = np.asarray(picture)
            if codes.min() < 0 or codes.max() > 65535:
                raise ParameterError(f"{field} = {str(path)!r}: integer pixels must be in 0..65535")
            return codes.astype(np.uint16)
        if picture.mode == "F":
            raise ParameterError(f"{field} = {str(path)!r}: a floating-point depth map must be .npy or .npz")
        return np.asarray(picture.convert("L"))


def read_picture(path: str | Path, low: float = 0.0, high: float = 1.0) -> npt.NDArray[Any]:
    """Read a picture as stored: gray or RGB codes, or linear values.

    Parameters
    ----------
    path : path
        The image.
    low, high : float
        Range of floating-point values.

    Returns
    -------
    uint8, uint16 or float32 (height, width) or uint8 (height, width, 3)
        Transparency shows white.

    Raises
    ------
    ParameterError
        If the file is missing, no image, damaged, too large, or holds NaN or infinity.
    """
    with opened(path, "scene") as picture:
        picture = ImageOps.exif_transpose(loaded(picture, path, "scene"))
        if picture.mode == "F":
            return _checked_values(np.asarray(picture), path, low, high)
        if picture.mode.startswith("I"):
            return _checked_codes(np.asarray(picture), path).astype(np.uint16)
        return np.asarray(picture.convert("L") if picture.mode in ("1", "L") else _opaque(picture))


def opened(path: str | Path, field: str) -> Image.Image:
    """Open an image file.

    Parameters
    ----------
    path : path
        The image.
    field : str
        Name in the messages.

    Returns
    -------
    Image
        Its header is read.

    Raises
    ------
    ParameterError
        If the file is missing, no image or too large.
    """
    path = Path(path)
    if path.is_dir():
        raise ParameterError(f"{field} = {str(path)!r}: must be an image file, not a folder")
    if not path.is_file():
        raise ParameterError(f"{field} = {str(path)!r}: no such file; must be a readable file")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # up to PIXELS_MAX is allowed; of odd metadata no picture may come
            picture = Image.open(path)
    except Image.DecompressionBombError:
        raise ParameterError(f"{field} = {str(path)!r}: must be an image of 1..{PIXELS_MAX} pixels") from None
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError) as error:
        Image.init()
        formats = ", ".join(name for name in FORMATS if name in Image.OPEN)
        raise ParameterError(
            f"{field} = {str(path)!r}: must be an image file that Pillow reads, {formats} ({type(error).__name__})"
        ) from None
    return picture


def frames_of(picture: Image.Image, path: str | Path) -> int:
    """Number of frames of an image.

    Parameters
    ----------
    picture : Image
        Result of `opened`.
    path : path
        Its file.

    Returns
    -------
    int
        1 where the format is none of ANIMATED.

    Raises
    ------
    ParameterError
        If it is damaged.
    """
    with undamaged("scene", path):
        return int(getattr(picture, "n_frames", 1)) if picture.format in ANIMATED else 1


def loaded(picture: Image.Image, path: str | Path, field: str) -> Image.Image:
    """Decode the pixels of an image.

    Parameters
    ----------
    picture : Image
        Result of `opened`, at any of its frames.
    path : path
        Its file.
    field : str
        Name in the messages.

    Returns
    -------
    Image
        The picture.

    Raises
    ------
    ParameterError
        If it is damaged.
    """
    with undamaged(field, path), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # odd metadata is no concern of ours; damaged pixels raise
        picture.load()
    return picture


@contextmanager
def undamaged(field: str, path: str | Path, part: str = "the image") -> Iterator[None]:
    """Decode within: a damaged file may raise nearly anything in a decoder.

    Parameters
    ----------
    field : str
        Name in the message.
    path : path
        The file.
    part : str
        What is decoded.

    Yields
    ------
    None
        To what decodes.

    Raises
    ------
    ParameterError
        In place of any exception.
    """
    try:
        yield
    except Exception as error:
        raise ParameterError(f"{field} = {str(path)!r}: {part} is damaged ({error})") from None


def _luminance(picture: Image.Image, path: str | Path, factor: int) -> npt.NDArray[np.float32]:
    if picture.mode == "F":
        _checked_values(np.asarray(picture), path)
        return _reduced(picture, factor, np.float32)
    if picture.mode.startswith("I"):
        codes = _checked_codes(np.asarray(picture), path)
        return decode16(_reduced(Image.fromarray(codes.astype(np.float32)), factor, np.float32) / 65535)
    if picture.mode in ("1", "L"):
        return linear(_reduced(picture.convert("L"), factor, np.uint8))
    return linear(_reduced(_opaque(picture), factor, np.uint8))


def _opaque(picture: Image.Image) -> Image.Image:
    """RGB, transparency white."""
    if "A" in picture.mode or "transparency" in picture.info:
        picture = picture.convert("RGBA")
        page = Image.new("RGBA", picture.size, (255, 255, 255, 255))
        picture = Image.alpha_composite(page, picture)
    return picture.convert("RGB")


def _checked_codes(codes: npt.NDArray[Any], path: str | Path) -> npt.NDArray[Any]:
    if codes.min() < 0 or codes.max() > 65535:
        raise ParameterError(f"scene = {str(path)!r}: integer pixels must be in 0..65535")
    return codes


def _checked_values(
    values: npt.NDArray[Any], path: str | Path, low: float = 0.0, high: float = 1.0
) -> npt.NDArray[Any]:
    smallest, largest = float(values.min()), float(values.max())
    if not (smallest >= low and largest <= high):
        worst = largest if smallest >= low else smallest
        raise ParameterError(
            f"scene = {str(path)!r}: pixel value {worst:g}: every floating-point pixel must be a "
            f"finite number in [{low:g}, {high:g}]"
        )
    return values


def _reduced(picture: Image.Image, factor: int, dtype: npt.DTypeLike) -> npt.NDArray[Any]:
    return np.asarray(picture.reduce(factor) if factor > 1 else picture, dtype)


def decode16(unit: npt.NDArray[np.floating]) -> npt.NDArray[Any]:
    """Linear light of sRGB codes.

    Parameters
    ----------
    unit : array (...)
        Codes over the largest one, 0..1.

    Returns
    -------
    array (...)
        0..1.

    References
    ----------
    [IEC61966-2-1].
    """
    return np.where(unit <= 0.04045, unit / 12.92, ((unit + 0.055) / 1.055) ** 2.4)


def encode16(light: npt.NDArray[np.floating]) -> npt.NDArray[Any]:
    """SRGB codes of linear light: the inverse of `decode16`.

    Parameters
    ----------
    light : array (...)
        0..1.

    Returns
    -------
    array (...)
        Codes over the largest one, 0..1, not rounded.

    References
    ----------
    [IEC61966-2-1].
    """
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
