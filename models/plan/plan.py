"""What a frame of a scene needs, decided before anything is computed; what it does not need is left out."""

from dataclasses import dataclass, field

import numpy as np

from models.digital.scan import Scan
from models.parameters import ALL_TYPES

from .flat import flat_tiles


@dataclass(frozen=True, eq=False)
class Plan:
    """angular: the views differ and all are read; else one stands for all.
    polarized: the polarization of the light is weighed by the gratings.
    captures: passes of the capture operator, 1, 3 or 4.  taps: sub-frames, 1 or 4.
    read: bool (rows, cols), pixels that the frame reads.
    flat: bool (tile rows, tile cols), tiles in which no sample can reach the threshold (edge mode, noise aside).
    left_out: what was left out, why, and what that saved: dicts of 'what', 'why', 'saved'.
    """

    angular: bool
    polarized: bool
    taps: int
    captures: int
    read: np.ndarray
    flat: np.ndarray
    left_out: tuple = field(default_factory=tuple)


def plan(scene, sensor, frame):
    """The Plan of one frame. scene: a Scene of the sensor's size. frame: FrameParameters. Raises ParameterError."""
    rows, cols = scene.shape
    read = Scan(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, frame, sensor.tile).read
    taps = 4 if frame.mode == "tof" else 1
    captures, tap_note = _captures(scene, taps)
    angular, polarized = scene.angular, scene.polarization is not None
    views = scene.views**2
    notes = [tap_note] if tap_note else []
    if not angular:
        notes.append(
            (
                "views",
                "no angle content: all views are equal",
                f"{views - 1} of {views} views of {captures} "
                f"capture passes, {_megabytes((views - 1) * rows * cols * scene.light_field.itemsize)}",
            )
        )
    if not polarized:
        notes.append(
            ("polarization", "the light is unpolarized", f"a factor on each of {int(read.sum()):,} diode pairs")
        )
    unread = rows * cols - int(read.sum())
    if unread:
        why = "pixel types masked" if frame.mask != ALL_TYPES else "outside the window or between the tiles read"
        notes.append(("unread pixels", why, f"{unread:,} of {rows * cols:,} pixels neither captured nor sequenced"))
    flat = flat_tiles(scene, sensor, frame)
    if flat.any():
        samples = int((read & _spread(flat, sensor)).sum())
        notes.append(
            (
                "conversions of flat tiles",
                f"no sample there can reach threshold {frame.threshold}, noise aside",
                f"{samples:,} conversions in {int(flat.sum()):,} of {flat.size:,} tiles",
            )
        )
    left_out = tuple({"what": what, "why": why, "saved": saved} for what, why, saved in notes)
    return Plan(angular, polarized, taps, captures, read, flat, left_out)


def _captures(scene, taps):
    """Capture passes that a frame takes, and what is left out for it."""
    if taps == 1:
        return 1, ("time-of-flight taps", "the mode reads none", "3 of 4 sub-frames")
    if scene.static and (scene.depth is None or not np.ptp(scene.depth)):
        return 1, (
            "capture passes of the taps",
            "static scene at one depth: each tap is the same frame, scaled",
            "3 of 4 capture passes",
        )
    if scene.static:
        return 3, (
            "capture passes of the taps",
            "static scene: mean, cosine and sine give all four taps",
            "1 of 4 capture passes",
        )
    return 4, None


def _spread(flat, sensor):
    tile = sensor.tile
    return np.repeat(np.repeat(flat, tile.rows, 0), tile.cols, 1)[: sensor.array.rows, : sensor.array.cols]


def _megabytes(count):
    return f"{count / 1e6:.1f} MB of light field"
