"""A sensor over the spread of its process, the light, the focus and the temperature: worst case and yield.

Every case is the whole sensor simulated in full again. The host knows each chip as a calibration would: the estimators
get the case's optics; its trims come from its own flat field.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from talbot.base.progress import each
from talbot.imaging.explore.budget import Limit, broken
from talbot.imaging.explore.pool import Failure, Pool
from talbot.imaging.explore.search import Plan, Record, Row, considered, work
from talbot.imaging.explore.space import Point
from talbot.imaging.explore.task import FULL, Task
from talbot.imaging.explore.tasks import SceneTask
from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.parameters.electrical import TEMPERATURE
from talbot.models.parameters.sources import sourced

LIGHT, FOCUS, CELSIUS = (0.5, 2.0), (0.95, 1.05), (0.0, 60.0)
KELVIN = 273.15
ROOM_ERROR = 1.1  # of the nominal error, that a chip may have where no limit names one


@dataclass(frozen=True)
class Spread:
    """Standard deviations of a process, relative; doubling: K that double the dark current.

    Attributes
    ----------
    m, full_well, read_noise, difference_gain : float
        Of these fields of the sensor.
    doubling : float
        Of the dark current, in K.
    """

    m: float = sourced(0.05, "assumed")
    full_well: float = sourced(0.05, "assumed")
    read_noise: float = sourced(0.1, "assumed")
    difference_gain: float = sourced(0.02, "assumed")
    doubling: float = sourced(8.0, "assumed", "K")


@dataclass(frozen=True)
class Case:
    """One case: what differs from the nominal sensor, the sensor, its task, and the seed of its chip."""

    kind: str
    name: str
    sensor: SensorParameters
    task: Task
    seed: int


def cases(plan: Plan, point: Point, draws: int, spread: Spread | None = None) -> Iterator[Case]:
    """The cases of a point: ``draws`` chips, then light, focus and temperature at the ends of their ranges."""
    spread, sensor, task = spread or Spread(), point.sensor, plan.task
    for draw in range(1, draws + 1):
        rng = np.random.default_rng([plan.seed, draw, 59])
        e = sensor.electrical
        m, well, noise, gain = 1 + rng.standard_normal(4) * (
            spread.m,
            spread.full_well,
            spread.read_noise,
            spread.difference_gain,
        )
        electrical = replace(
            e, full_well=e.full_well * well, read_noise=e.read_noise * noise, difference_gain=e.difference_gain * gain
        )
        optics = replace(sensor.optics, m=min(sensor.optics.m * m, 1.0))
        converter = replace(sensor.converter, seed=(sensor.converter.seed + draw) % (1 << 32))
        chip = replace(sensor, optics=optics, electrical=electrical, converter=converter)
        yield Case("process", f"chip {draw}", chip, task, plan.seed + draw)
    for factor in LIGHT:
        lit = replace(sensor.electrical, white_current=factor * sensor.electrical.white_current)
        dim = replace(task, lux=factor * task.lux) if isinstance(task, SceneTask) else task
        yield Case("light", f"{factor:g} of the light", replace(sensor, electrical=lit), dim, plan.seed)
    for factor in FOCUS:
        camera = sensor.optics.camera
        focused = replace(sensor.optics, camera=replace(camera, focus=factor * camera.focus))
        yield Case("focus", f"focus at {factor:g} of its distance", replace(sensor, optics=focused), task, plan.seed)
    for celsius in CELSIUS:
        e, kelvin = sensor.electrical, celsius + KELVIN
        warm = replace(
            e,
            dark_current=e.dark_current * 2 ** ((kelvin - TEMPERATURE) / spread.doubling),
            read_noise=e.read_noise * float(np.sqrt(kelvin / TEMPERATURE)),
        )
        yield Case("temperature", f"{celsius:g} C", replace(sensor, electrical=warm), task, plan.seed)


def robustness(plan: Plan, row: Row, draws: int) -> dict[str, Any]:
    """Figures of each case of the point ``row``, the worst of each kind, and the yield of the process.

    A chip is good that keeps the limits; where none names the error, one whose error is at most `ROOM_ERROR` of the
    nominal. Raises ParameterError.
    """
    point = considered(plan.task, row.values, ())
    if isinstance(point, str):
        raise ParameterError(point)
    nominal = (row.full or {})["figures"]
    limits = plan.limits
    if not any(limit.name == "error" for limit in limits):
        limits = (*limits, Limit("error", True, ROOM_ERROR * nominal["error"]))
    every = list(cases(plan, point, draws))
    calls = [(case.task, Point(point.values, case.sensor, point.settings), FULL, case.seed) for case in every]
    records: dict[int, Record] = {}
    with Pool(plan.workers, plan.seconds) as pool:
        for number, result in each(pool.run(work, calls), "robustness", total=len(calls)):
            records[number] = {"failed": result.reason} if isinstance(result, Failure) else result
    out = []
    for number, case in enumerate(every):
        figures = records[number].get("figures")
        reason = records[number].get("refused") or records[number].get("failed") or ""
        why = reason if figures is None else broken(limits, figures)
        out.append({"kind": case.kind, "case": case.name, "good": not why, "why": why, "figures": figures})
    process = [entry["good"] for entry in out if entry["kind"] == "process"]
    errors = {
        kind: max((c["figures"]["error"] for c in out if c["kind"] == kind and c["figures"]), default=None)
        for kind in ("process", "light", "focus", "temperature")
    }
    return {
        "point": row.number,
        "nominal": nominal,
        "limits": [str(limit) for limit in limits],
        "yield": sum(process) / len(process) if process else None,
        "chips": len(process),
        "worst_error": errors,
        "cases": out,
    }
