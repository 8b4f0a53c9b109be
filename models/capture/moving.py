"""A scene that moves, through a rolling shutter: each row sees it while it integrates, and no longer."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from talbot.models.capture.frame import currents
from talbot.models.capture.pupil import Region
from talbot.models.digital.exposure import windows
from talbot.models.parameters import AmpTiming, ParameterError, SensorParameters
from talbot.models.plan import Plan
from talbot.models.scene import Scene

STEP = 0.5  # px that the scene moves at most between two instants
INSTANTS_MAX = 2000


def instants(scene: Scene, sensor: SensorParameters, plan: Plan, timing: AmpTiming) -> int:
    """Count the instants of a frame between which a scene moves half a pixel at most.

    scene: of the sensor's size. sensor: the sensor. plan: plan of the same scene and sensor. timing: of the frame as it
    exposes. Returns 1 to INSTANTS_MAX; 1 for a scene that does not move. Raises ParameterError for time of flight of a
    scene that moves, and for one that moves too far in a frame.
    """
    if scene.moved is None or not scene.speed:
        return 1
    if plan.taps != 1:
        raise ParameterError("scene = moving: must not move in time of flight")
    starts, span = windows(timing, int(plan.read.any(1).sum()))
    travel = scene.speed * (starts[-1] + span) / sensor.chip.f_clk
    count = int(np.ceil(max(travel / STEP, 1)))
    if count > INSTANTS_MAX:
        raise ParameterError(f"scene travel = {travel:.0f} px a frame: must be at most {INSTANTS_MAX * STEP:.0f}")
    return count


def moving_currents(
    scene: Scene, sensor: SensorParameters, plan: Plan, timing: AmpTiming, regions: Sequence[Region] | None = None
) -> npt.NDArray[np.floating]:
    """Photocurrents of a frame, each row's the mean over the time in which it integrates.

    The frame is cut into instants between which the scene moves half a pixel at most; an instant is captured for the
    rows that integrate in it. A scene that does not move is captured once.

    scene: of the sensor's size. sensor: the sensor. plan: plan of the same scene and sensor. timing: of the frame as it
    exposes. regions: as in `currents`. Returns (taps, 2, rows, cols), as of `currents`.
    Raises ParameterError as `currents` and `instants`.
    """
    if scene.moved is None or not scene.speed:
        return currents(scene, sensor, plan, regions)
    count = instants(scene, sensor, plan, timing)
    read = np.flatnonzero(plan.read.any(1))
    starts, span = windows(timing, read.size)
    begin, total = np.array(starts), starts[-1] + span
    out = np.zeros((1, 2, *scene.shape))
    ends = np.linspace(0, total, count + 1)
    for first, last in zip(ends[:-1], ends[1:]):
        share = np.clip(np.minimum(begin + span, last) - np.maximum(begin, first), 0, None) / span
        seen = np.zeros_like(plan.read)
        seen[read[share > 0]] = plan.read[read[share > 0]]
        if seen.any():
            now = scene.moved((first + last) / 2 / sensor.chip.f_clk)
            part = currents(now, sensor, replace(plan, read=seen), regions)
            out[:, :, read] += part[:, :, read] * share[:, None]
    return out
