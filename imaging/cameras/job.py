"""One run of `talbot cameras`: a job for each camera and light, and for each number of measurements."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.jobs import Job
from talbot.base.jobs import run as run_jobs
from talbot.imaging.cameras import measure, measurements
from talbot.models.capture.cameras import CAMERAS, LIGHT
from talbot.models.scene import Sampling, load

STORE = Path("parts")  # of the results' folder: kept parts of a run
SWEPT = 2  # scenes over which the number of measurements is swept, the first of the run's


@dataclass(frozen=True)
class Comparison:
    """What is compared.

    scenes: names or files. size: pixels of a side. lux: of white, the brightest first. seeds: how many. measurements:
    whether their number is swept, too. workers: processes.
    """

    scenes: tuple[str, ...] = measure.SCENES
    size: int = 120
    lux: tuple[float, ...] = measure.LUX
    seeds: int = 3
    measurements: bool = False
    workers: int = 1


def compare(task: Comparison, store: Path) -> dict[str, Any]:
    """Return the summary of ``task``; parts that are ready are kept in ``store``. Raises ParameterError."""
    sampling = Sampling.of(measure.sensor_of(task.size))
    for name in task.scenes:
        load(name, sampling)  # refused here, before anything is computed
    brightest = task.lux[0]
    learning = measure.TRAINING, task.size, brightest
    plain = run_jobs([Job("learned", measure.learned, learning, (repr(learning),))], store, "plain camera", 1)[0]
    jobs, files = [], [Path(name) for name in task.scenes if Path(name).is_file()]
    for lux in task.lux:
        for name in CAMERAS:
            call = name, task.scenes, task.size, lux, brightest, task.seeds, plain["disparity"]
            jobs.append(Job(f"{name}_{lux:g}", measure.measured, call, (repr(call), *files)))
    sweep = []
    for point in measurements.points() if task.measurements else ():
        call = point, task.scenes[:SWEPT]
        sweep.append(Job("_".join(map(str, point)), measurements.measured, call, (repr(call), *files)))
    every = run_jobs([*jobs, *sweep], store, "cameras", task.workers)
    rows = sum(every[: len(jobs)], [])
    return {
        "scenes": task.scenes,
        "size": task.size,
        "lux": task.lux,
        "seeds": task.seeds,
        "exposure_s": rows[0]["exposure_s"],
        "light": dict(LIGHT),
        "training": measure.TRAINING,
        "candidates": measure.CANDIDATES,
        "plain": plain,
        "rows": rows,
        "swept_scenes": task.scenes[:SWEPT],
        "swept_size": measurements.SIZE,
        "measurements": every[len(jobs) :],
    }
