"""The work that a frame of a scene needs, decided before anything is computed; the rest is left out."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.digital.scan import Scan
from talbot.models.parameters import ALL_TYPES, FrameParameters, SensorParameters
from talbot.models.scene import Scene


class LeftOut(NamedTuple):
    """Work that a plan leaves out.

    what, why, saved: the work, the reason, and the amount.
    """

    what: str
    why: str
    saved: str


@dataclass(frozen=True, eq=False)
class Plan:
    """Work of one frame.

    angular: the views differ and all are read; else one represents all.
    polarized: the light is polarized and weighted by the gratings.
    taps: sub-frames, 1 or 4.
    captures: passes of the capture operator, 1, 3 or 4.
    read: (rows, cols), pixels that the frame reads.
    left_out: work that is left out.
    """

    angular: bool
    polarized: bool
    taps: int
    captures: int
    read: npt.NDArray[np.bool_]
    left_out: tuple[LeftOut, ...] = ()


def plan(scene: Scene, sensor: SensorParameters, frame: FrameParameters) -> Plan:
    """Plan one frame.

    scene: of the sensor's size. sensor: the sensor. frame: configuration of the frame. Returns Plan: its work. Raises
    ParameterError if the window is outside the array or selects no pixel.
    """
    rows, cols = scene.shape
    read = Scan(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, frame, sensor.tile).read
    taps = 4 if frame.mode == "tof" else 1
    captures, tap_note = _captures(scene, taps, bool(sensor.electrical.code))
    angular, polarized = scene.angular, scene.polarization is not None
    views = scene.views**2
    notes = [tap_note] if tap_note else []
    if not angular:
        notes.append(
            LeftOut(
                "views",
                "no angle content: all views are equal",
                f"{views - 1} of {views} views of {captures} "
                f"capture passes, {_megabytes((views - 1) * rows * cols * scene.image.itemsize)}",
            )
        )
    if not polarized:
        notes.append(
            LeftOut("polarization", "the light is unpolarized", f"a factor on each of {int(read.sum()):,} diode pairs")
        )
    unread = rows * cols - int(read.sum())
    if unread:
        why = "pixel types masked" if frame.mask != ALL_TYPES else "outside the window or between the tiles read"
        saved = f"{unread:,} of {rows * cols:,} pixels not sequenced, nor captured where none is read near"
        notes.append(LeftOut("unread pixels", why, saved))
    return Plan(angular, polarized, taps, captures, read, tuple(notes))


def _captures(scene: Scene, taps: int, coded: bool) -> tuple[int, LeftOut | None]:
    """Capture passes of a frame, and those that it leaves out."""
    if taps == 1:
        return 1, LeftOut("time-of-flight taps", "the mode reads none", "3 of 4 sub-frames")
    if scene.static and scene.echo is None and (scene.depth is None or not np.ptp(scene.depth)):
        return 1, LeftOut(
            "capture passes of the taps",
            "static scene at one depth: each tap is the same frame, scaled",
            "3 of 4 capture passes",
        )
    if scene.static and not coded:
        return 3, LeftOut(
            "capture passes of the taps",
            "static scene: mean, cosine and sine give all four taps",
            "1 of 4 capture passes",
        )
    return 4, None


def _megabytes(count: int) -> str:
    return f"{count / 1e6:.1f} MB of light field"
