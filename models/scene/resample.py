"""Pictures of any size -> the array's size: the largest centred crop of its shape, anti-aliased."""

import numpy as np
from PIL import Image


def centre_box(height, width, rows, cols):
    """(left, upper, right, lower) in px of the largest centred part with the shape rows : cols."""
    step = min(height / rows, width / cols)
    h, w = min(step * rows, height), min(step * cols, width)
    return (width - w) / 2, (height - h) / 2, (width + w) / 2, (height + h) / 2


def resize(values, rows, cols, box=None):
    """``values`` (2-D) -> float64 (rows, cols), each pixel a mean over what it covers (no overshoot).

    Enlarged, it is interpolated linearly. box: the part to take, in px, default all of it.
    """
    picture = Image.fromarray(np.ascontiguousarray(values, np.float32))
    height, width = values.shape
    box = box or (0, 0, width, height)
    shrinks = (box[3] - box[1]) / rows >= 1 and (box[2] - box[0]) / cols >= 1
    kernel = Image.Resampling.HAMMING if shrinks else Image.Resampling.BILINEAR
    return np.asarray(picture.resize((cols, rows), kernel, box=box), float)


def pick(values, rows, cols, box=None):
    """The nearest of ``values`` (2-D) at the middle of every pixel: nothing is mixed across a depth edge."""
    height, width = values.shape
    left, upper, right, lower = box or (0, 0, width, height)
    y = np.minimum((upper + (np.arange(rows) + 0.5) * (lower - upper) / rows).astype(int), height - 1)
    x = np.minimum((left + (np.arange(cols) + 0.5) * (right - left) / cols).astype(int), width - 1)
    return np.asarray(values[y[:, None], x[None, :]], float)


def linear(codes):
    """sRGB codes, uint8 (..., 1 or 3), or gray (rows, cols) -> linear luminance 0..1, float32 [IEC61966-2-1]."""
    steps = np.arange(256) / 255
    decoded = np.where(steps <= 0.04045, steps / 12.92, ((steps + 0.055) / 1.055) ** 2.4).astype(np.float32)
    if codes.ndim == 2:
        return decoded[codes]
    weights = np.float32([0.2126, 0.7152, 0.0722])  # Rec. 709
    return sum(w * decoded[codes[..., i]] for i, w in enumerate(weights))
