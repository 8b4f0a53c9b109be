"""Binary gradients: a pixel is active where its neighbourhood's contrast passes a threshold.

[Jayasuriya2017], App. A: spatial (Eq. A.1), temporal (Eq. A.2), several bits and their power (Eq. A.3).
"""

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_int, check_real

SCAN = 0.0024e-6  # W a pixel scanned [Jayasuriya2017, Sec. A.3.2]
DELIVER = 0.0195e-6  # W a pixel delivered
RATE = 30.0  # frames/s of these
BITS_MAX = 8
Bools = npt.NDArray[np.bool_]


def contrast(pictures: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Largest difference among a pixel, its left and its top neighbour.

    Parameters
    ----------
    pictures : array (..., height, width)
        Intensity, any unit. The first row and column have themselves as the neighbour that they lack.

    Returns
    -------
    float64 (..., height, width)
        max(\\|P - L\\|, \\|P - T\\|, \\|L - T\\|).
    """
    p = np.asarray(pictures, np.float64)
    left = np.concatenate([p[..., :1], p[..., :-1]], -1)
    top = np.concatenate([p[..., :1, :], p[..., :-1, :]], -2)
    three = np.stack([p, left, top])
    return three.max(0) - three.min(0)


def spatial(pictures: npt.ArrayLike, threshold: float) -> Bools:
    """Binary spatial gradient.

    Parameters
    ----------
    pictures : array (..., height, width)
        Intensity.
    threshold : float
        In the same unit, 0 or more.

    Returns
    -------
    bool (..., height, width)
        True where a pixel is active.

    References
    ----------
    [Jayasuriya2017], Eq. A.1.
    """
    check_real("threshold", threshold, 0, 1e9)
    return contrast(pictures) > threshold


def temporal(now: npt.ArrayLike, before: npt.ArrayLike) -> Bools:
    """Binary temporal gradient: the activity of a pixel changes.

    Parameters
    ----------
    now, before : bool (..., height, width)
        Spatial gradients of two frames.

    Returns
    -------
    bool (..., height, width)
        True where they differ.

    Raises
    ------
    ParameterError
        For two shapes.

    References
    ----------
    [Jayasuriya2017], Eq. A.2.
    """
    now, before = np.asarray(now, bool), np.asarray(before, bool)
    if now.shape != before.shape:
        raise ParameterError(f"before = {before.shape}: must be {now.shape}, as now")
    return now ^ before


def levels(pictures: npt.ArrayLike, bits: int, threshold: float) -> npt.NDArray[np.uint8]:
    """Gradient of several bits, as by frames that are added.

    Parameters
    ----------
    pictures : array (..., height, width)
        Intensity.
    bits : int
        1..8.
    threshold : float
        Of one bit, more than 0. 2**bits - 1 thresholds are spread evenly up to twice this one, which is their middle.

    Returns
    -------
    uint8 (..., height, width)
        Number of thresholds passed, 0..2**bits-1; of one bit as `spatial`.

    References
    ----------
    [Jayasuriya2017], Sec. A.4.2.
    """
    check_int("bits", bits, 1, BITS_MAX)
    check_real("threshold", threshold, 1e-9, 1e9)
    step = threshold / (1 << bits - 1)
    return np.clip(np.ceil(contrast(pictures) / step) - 1, 0, (1 << bits) - 1).astype(np.uint8)


def power(bits: int, pixels: int, active: float) -> float:
    """Power of a camera of binary gradients.

    Parameters
    ----------
    bits : int
        1..8.
    pixels : int
        Of the array.
    active : float
        Share of the pixels that is active, and is delivered, 0..1.

    Returns
    -------
    float
        In W at `RATE` frames/s: 2**bits scans, and a delivery.

    References
    ----------
    [Jayasuriya2017], Eq. A.3.
    """
    check_int("bits", bits, 1, BITS_MAX)
    check_int("pixels", pixels, 1, 1 << 31)
    check_real("active", active, 0, 1)
    return pixels * ((1 << bits) * SCAN + active * DELIVER)


def packed_bytes(pixels: int, bits: int) -> int:
    """Bytes of a frame of gradients sent as a bit map.

    Parameters
    ----------
    pixels : int
        Of the array.
    bits : int
        A pixel, 1..8.

    Returns
    -------
    int
        Without a header.
    """
    return -(-pixels * bits // 8)
