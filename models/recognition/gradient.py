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

    pictures: (..., height, width), intensity, any unit. The first row and column have themselves as the neighbour that
    they lack. Returns (..., height, width): max(|P - L|, |P - T|, |L - T|).
    """
    p = np.asarray(pictures, np.float64)
    left = np.concatenate([p[..., :1], p[..., :-1]], -1)
    top = np.concatenate([p[..., :1, :], p[..., :-1, :]], -2)
    three = np.stack([p, left, top])
    return three.max(0) - three.min(0)


def spatial(pictures: npt.ArrayLike, threshold: float) -> Bools:
    """Binary spatial gradient.

    pictures: (..., height, width), intensity. threshold: in the same unit, 0 or more. Returns (..., height, width),
    True where a pixel is active. Source: [Jayasuriya2017], Eq. A.1.
    """
    check_real("threshold", threshold, 0, 1e9)
    return contrast(pictures) > threshold


def temporal(now: npt.ArrayLike, before: npt.ArrayLike) -> Bools:
    """Binary temporal gradient: the activity of a pixel changes.

    now, before: (..., height, width), spatial gradients of two frames. Returns (..., height, width), True where they
    differ. Raises ParameterError for two shapes. Source: [Jayasuriya2017], Eq. A.2.
    """
    now, before = np.asarray(now, bool), np.asarray(before, bool)
    if now.shape != before.shape:
        raise ParameterError(f"before = {before.shape}: must be {now.shape}, as now")
    return now ^ before


def levels(pictures: npt.ArrayLike, bits: int, threshold: float) -> npt.NDArray[np.uint8]:
    """Gradient of several bits, as by frames that are added.

    pictures: (..., height, width), intensity. bits: 1..8. threshold: of one bit, more than 0. 2**bits - 1 thresholds
    are spread evenly up to twice this one, which is their middle. Returns (..., height, width), number of thresholds
    passed, 0..2**bits-1; of one bit as `spatial`. Source: [Jayasuriya2017], Sec. A.4.2.
    """
    check_int("bits", bits, 1, BITS_MAX)
    check_real("threshold", threshold, 1e-9, 1e9)
    step = threshold / (1 << bits - 1)
    return np.clip(np.ceil(contrast(pictures) / step) - 1, 0, (1 << bits) - 1).astype(np.uint8)


def power(bits: int, pixels: int, active: float) -> float:
    """Power of a camera of binary gradients.

    bits: 1..8. pixels: of the array. active: share of the pixels that is active, and is delivered, 0..1. Returns float:
    in W at `RATE` frames/s: 2**bits scans, and a delivery. Source: [Jayasuriya2017], Eq. A.3.
    """
    check_int("bits", bits, 1, BITS_MAX)
    check_int("pixels", pixels, 1, 1 << 31)
    check_real("active", active, 0, 1)
    return pixels * ((1 << bits) * SCAN + active * DELIVER)


def energy(bits: int, pixels: int, active: float) -> float:
    """Energy of a frame of binary gradients.

    bits, pixels, active: as of `power`. Returns float: in J.
    """
    return power(bits, pixels, active) / RATE


def threshold_of(pictures: npt.ArrayLike, active: float) -> float:
    """Threshold above which a share of the pixels is active.

    pictures: (n, height, width), intensity. active: the share, 0..1. Returns float: in the unit of the intensity.
    """
    check_real("active", active, 0, 1)
    return float(np.quantile(contrast(pictures), 1 - active))


def packed_bytes(pixels: int, bits: int) -> int:
    """Bytes of a frame of gradients sent as a bit map.

    pixels: of the array. bits: a pixel, 1..8. Returns int: without a header.
    """
    return -(-pixels * bits // 8)
