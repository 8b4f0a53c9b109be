"""Resampling of pictures to the array's size: the largest centred crop of its shape, anti-aliased."""

from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

Box = tuple[float, float, float, float]  # left, upper, right, lower in px


def centre_box(height: int, width: int, rows: int, cols: int) -> Box:
    """Largest centred part of a picture with the proportions of the array.

    height, width: size of the picture in px. rows, cols: size of the array in px. Returns Box: in px of the picture.
    """
    step = min(height / rows, width / cols)
    h, w = min(step * rows, height), min(step * cols, width)
    return (width - w) / 2, (height - h) / 2, (width + w) / 2, (height + h) / 2


def resize(values: npt.NDArray[np.floating], rows: int, cols: int, box: Box | None = None) -> npt.NDArray[np.float64]:
    """Reduce a picture by averaging, without overshoot, or enlarge it by linear interpolation.

    values: (height, width), the picture. rows, cols: size of the result. box: part to take; the whole picture by
    default. Returns (rows, cols): means over the area of each pixel.
    """
    picture = Image.fromarray(np.ascontiguousarray(values, np.float32))
    height, width = values.shape
    box = box or (0, 0, width, height)
    shrinks = (box[3] - box[1]) / rows >= 1 and (box[2] - box[0]) / cols >= 1
    kernel = Image.Resampling.HAMMING if shrinks else Image.Resampling.BILINEAR
    return np.asarray(picture.resize((cols, rows), kernel, box=box), float)


def pick(values: npt.NDArray[Any], rows: int, cols: int, box: Box | None = None) -> npt.NDArray[np.float64]:
    """Nearest value at the middle of every pixel: nothing is mixed across a depth edge.

    values: (height, width), the picture. rows, cols: size of the result. box: part to take; the whole picture by
    default. Returns (rows, cols): values of the picture.
    """
    height, width = values.shape
    left, upper, right, lower = box or (0, 0, width, height)
    y = np.minimum((upper + (np.arange(rows) + 0.5) * (lower - upper) / rows).astype(int), height - 1)
    x = np.minimum((left + (np.arange(cols) + 0.5) * (right - left) / cols).astype(int), width - 1)
    return np.asarray(values[y[:, None], x[None, :]], float)


def linear(codes: npt.NDArray[np.uint8]) -> npt.NDArray[np.float32]:
    """Linear luminance of sRGB codes.

    codes: (rows, cols) or (rows, cols, 3), gray or colour. Returns float32 (rows, cols): 0..1. [IEC61966-2-1].
    """
    steps = np.arange(256) / 255
    decoded = np.where(steps <= 0.04045, steps / 12.92, ((steps + 0.055) / 1.055) ** 2.4).astype(np.float32)
    if codes.ndim == 2:
        return decoded[codes]
    weights = np.array([0.2126, 0.7152, 0.0722], np.float32)  # Rec. 709
    red, green, blue = (w * decoded[codes[..., i]] for i, w in enumerate(weights))
    return red + green + blue
