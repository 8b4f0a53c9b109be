"""The search: batches of points that Optuna asks for, in a small scene first, the promising ones in full.

Any number of workers evaluates the points of a batch, in any order; the study gets them in the order of the batch. The
sampler of a batch is seeded by the seed and the batch's number. Results thus depend on the seed, the batch and the
trials, not on the workers. A run that continues asks the same again, and takes from the store what is in it.
"""

import base64
import contextlib
import io
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np
import numpy.typing as npt
import optuna
from optuna.distributions import BaseDistribution, CategoricalDistribution, FloatDistribution, IntDistribution
from optuna.samplers import BaseSampler, NSGAIISampler, RandomSampler, TPESampler
from optuna.trial import Trial, TrialState
from PIL import Image
from threadpoolctl import threadpool_limits

from talbot.base.cache import digest
from talbot.base.progress import each
from talbot.base.sources import code
from talbot.imaging.explore import costs
from talbot.imaging.explore.budget import Limit, broken
from talbot.imaging.explore.pool import Failure, Pool
from talbot.imaging.explore.space import Point, Space, point_of
from talbot.imaging.explore.store import Store, key
from talbot.imaging.explore.task import FULL, MORE, SMALL, Fidelity, Floats, Task
from talbot.models.parameters import ParameterError
from talbot.models.parameters.sensor_file import values as values_of

SAMPLERS = "tpe", "nsga", "random"
ASKED = 40  # times that a batch's size is asked for at most, until its sensors keep what is known before
THUMBNAIL = 128  # px, of a picture on the page
EXACT = "area_mm2", "frames_per_s"  # known before anything is simulated; energy and bytes have a least value
Record = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Plan:
    """What is searched. objectives: figures; limits: of figures; batch: points that are asked for together.

    multi: a small scene first. seconds: that a trial may take. thesis: its sensor as well, in full.
    """

    task: Task
    space: Space
    objectives: tuple[str, ...]
    limits: tuple[Limit, ...] = ()
    trials: int = 40
    batch: int = 8
    seed: int = 1
    sampler: str = SAMPLERS[0]
    multi: bool = True
    workers: int = 1
    seconds: float = 1800.0
    thesis: bool = True

    @property
    def digest(self) -> str:
        """Of all that decides the results of a point and which points come next."""
        base = json.dumps(values_of(self.task.base), default=str)
        decides = self.task.name, *self.task.content(), json.dumps(dict(self.space)), base, self.objectives
        return digest(*decides, *self.limits, self.batch, self.seed, self.sampler, self.multi, code(__name__))


@dataclass(eq=False)
class Row:
    """A point that was asked for. status: full, small, refused or failed; reason: of the last two.

    small, full: figures, picture (PNG in base64) and seconds at that fidelity.
    """

    number: int
    values: dict[str, Any]
    status: str
    reason: str = ""
    small: Record | None = None
    full: Record | None = None
    front: bool = False

    @property
    def best(self) -> Record | None:
        """Of the highest fidelity that there is."""
        return self.full or self.small


@dataclass(eq=False)
class Findings:
    """A search that ended. thesis: the base itself. refused: sensors that were refused before any simulation, by why.

    history: (trials, seconds of evaluation) as each batch ended.
    """

    plan: Plan
    rows: list[Row]
    thesis: Row | None
    refused: dict[str, int] = field(default_factory=dict)
    history: list[tuple[int, float]] = field(default_factory=list)
    exhausted: bool = False

    @property
    def thesis_in_full(self) -> list[Row]:
        """The thesis's sensor where it was evaluated, else none."""
        return [self.thesis] if self.thesis and self.thesis.full else []

    def effective(self, row: Row) -> Mapping[str, Any]:
        """The values of a point that have an effect."""
        return self.plan.task.effective(row.values)

    def objectives(self) -> tuple[list[Row], npt.NDArray[np.float64]]:
        """Points in full, and their objectives, as `oriented` gives them."""
        rows = [row for row in self.rows if row.full]
        return rows, oriented([row.full["figures"] for row in rows if row.full], self.plan.objectives)

    @property
    def front(self) -> list[Row]:
        """Points in full that keep the limits and that no other beats in every objective."""
        return [row for row in self.rows if row.front]


def search(plan: Plan, path: Path) -> Findings:
    """Search, the evaluated points kept in the SQLite file ``path``. Raises ParameterError, OSError."""
    task = plan.task
    directions: list[Any] = ["maximize" if name in MORE else "minimize" for name in plan.objectives]
    distributions = {name: distribution(values) for name, values in plan.space.items()}
    store = Store(path, plan.digest, directions)
    try:
        with Pool(plan.workers, plan.seconds) as pool:
            judge = Judge(plan, store, distributions, pool)
            findings = Findings(plan, [], _thesis(judge))
            study = optuna.create_study(directions=directions)
            batches = _batches(plan, study, distributions, judge, findings)
            for _ in each(batches, task.name, lambda row: row.status, plan.trials):
                pass
    finally:
        store.close()
    chosen = [row for row in findings.rows if row.full and not broken(plan.limits, row.full["figures"])]
    best = undominated(oriented([row.full["figures"] for row in chosen if row.full], plan.objectives))
    for row, front in zip(chosen, best, strict=True):
        row.front = bool(front)
    return findings


class Judge:
    """Evaluates points, or takes them from the store."""

    def __init__(self, plan: Plan, store: Store, distributions: Mapping[str, BaseDistribution], pool: Pool) -> None:
        self.plan, self.store, self.pool = plan, store, pool
        self.distributions, self.records = distributions, store.records()

    def evaluate(self, rows: Sequence[Row], fidelity: Fidelity, study: str = "") -> Iterator[Row]:
        """Each row as its record at a fidelity is there. study: of the store, where that is not the fidelity."""
        plan, task, study = self.plan, self.plan.task, study or fidelity.name
        todo = []
        for row in rows:
            known = self.records.get((study, key(row.values)))
            if known is None:
                todo.append(row)
            else:
                _take(row, fidelity, known)
                yield row
        points = [considered(task, row.values, ()) for row in todo]
        arguments = [(task, point, fidelity, plan.seed) for point in points]
        for number, result in self.pool.run(work, arguments):
            row = todo[number]
            record: Record = {"failed": result.reason} if isinstance(result, Failure) else result
            figures = record.get("figures")
            objectives = None if figures is None else [figures[name] for name in plan.objectives]
            distributions = self.distributions
            if study != fidelity.name:  # a point outside the space
                distributions = {name: CategoricalDistribution([value]) for name, value in row.values.items()}
            self.store.add(study, row.values, distributions, objectives, record)
            self.records[study, key(row.values)] = record
            _take(row, fidelity, record)
            yield row


def _take(row: Row, fidelity: Fidelity, record: Record) -> None:
    """Put a record into its row."""
    for status in ("failed", "refused"):
        if status in record:
            row.status, row.reason = status, record[status]
            return
    setattr(row, fidelity.name, record)
    row.status = fidelity.name


def _thesis(judge: Judge) -> Row | None:
    """The thesis's sensor in full; None for a task without one."""
    task = judge.plan.task
    if not task.thesis or not judge.plan.thesis:
        return None
    row = Row(-1, dict(task.thesis), "full")
    return next(judge.evaluate([row], FULL, "thesis"))


def _batches(
    plan: Plan, study: optuna.Study, distributions: Mapping[str, BaseDistribution], judge: Judge, findings: Findings
) -> Iterator[Row]:
    """Each row as it ends; the study gets those of a batch in its order."""
    seconds = 0.0
    for number in range(math.ceil(plan.trials / plan.batch)):
        study.sampler = sampler_of(plan, number)
        size = min(plan.batch, plan.trials - number * plan.batch)
        trials = _ask(plan, study, distributions, size, findings)
        if not trials:
            findings.exhausted = True
            return
        rows = [row for _, row in trials]
        first = SMALL if plan.multi else FULL
        ended = list(judge.evaluate(rows, first))
        findings.rows += rows
        good = _promising(findings, plan) if plan.multi else []
        yield from (row for row in ended if row not in good)
        yield from judge.evaluate([row for row in good if row in rows], FULL)
        for trial, row in trials:
            record = row.small if plan.multi else row.full
            if record is None:
                study.tell(trial, state=TrialState.FAIL)
                continue
            for limit in early_limits(plan):
                trial.set_constraint(str(limit), limit.excess(record["figures"]))
            study.tell(trial, [record["figures"][name] for name in plan.objectives])
        seconds += sum(part["cpu_s"] for row in rows for part in (row.small, row.full) if part)
        findings.history.append((len(findings.rows), seconds))


def _ask(
    plan: Plan, study: optuna.Study, distributions: Mapping[str, BaseDistribution], size: int, findings: Findings
) -> list[tuple[Trial, Row]]:
    """The next ``size`` points that keep what is known before; fewer where the space has no more."""
    effective = plan.task.effective
    seen, out = {key(effective(row.values)) for row in findings.rows}, []
    for _ in range(ASKED * size):
        trial = study.ask(dict(distributions))
        point, name = considered(plan.task, trial.params, plan.limits), key(effective(trial.params))
        if isinstance(point, str) or name in seen:
            study.tell(trial, state=TrialState.FAIL)
            reason = point.partition(" = ")[0] if isinstance(point, str) else "asked for before"
            findings.refused[reason] = findings.refused.get(reason, 0) + 1
            continue
        seen.add(name)
        out.append((trial, Row(len(findings.rows) + len(out), dict(trial.params), "")))
        if len(out) == size:
            break
    return out


def _promising(findings: Findings, plan: Plan) -> list[Row]:
    """Rows that keep the limits in the small scene and that no other row so far beats there in every objective."""
    limits = early_limits(plan)
    rows = [row for row in findings.rows if row.small and not broken(limits, row.small["figures"])]
    best = undominated(oriented([row.small["figures"] for row in rows if row.small], plan.objectives))
    return [row for row, front in zip(rows, best, strict=True) if front]


def early_limits(plan: Plan) -> list[Limit]:
    """Limits of what is evaluated first: none of the error in a small scene, where it is another."""
    return [limit for limit in plan.limits if not plan.multi or limit.name != "error"]


def considered(task: Task, values: Mapping[str, Any], limits: Sequence[Limit]) -> Point | str:
    """The point of ``values``, or why there is none, by what is known before anything is simulated.

    That is: parameters' ranges, the columns' settling, area and time, and the least of energy and bytes.
    """
    try:
        point = point_of(task.effective(values), task.base)
        point = Point(point.values, task.sensor(point), point.settings)
        costs.check_settling(point.sensor)
        known = {"area_mm2": costs.area_mm2(point.sensor)}
        if requests := task.requests(point):
            known |= costs.least(requests)
    except ParameterError as error:
        return str(error)
    return broken([limit for limit in limits if limit.most or limit.name in EXACT], known) or point


def work(task: Task, point: Point, fidelity: Fidelity, seed: int) -> Record:
    """A record: figures, picture and seconds, or why the sensor cannot be."""
    start, spent = perf_counter(), process_time()
    try:
        with threadpool_limits(1), contextlib.redirect_stderr(io.StringIO()):  # its own lines of progress
            outcome = task.evaluate(point, fidelity, seed)
    except ParameterError as error:
        return {"refused": str(error)}
    figures = {name: float(value) for name, value in outcome.figures.items()}
    figures |= {"area_mm2": costs.area_mm2(point.sensor)}
    for name, value in figures.items():
        if not math.isfinite(value):
            return {"refused": f"{name} = {value}: must be finite"}
    return {
        "figures": figures,
        "picture": thumbnail(outcome.picture),
        "seconds": perf_counter() - start,
        "cpu_s": process_time() - spent,
    }


def thumbnail(picture: Floats) -> str:
    """A picture as PNG in base64, at most `THUMBNAIL` px; its darkest and brightest are black and white."""
    values = np.nan_to_num(np.asarray(picture, float))
    low, span = values.min(), np.ptp(values)
    image = Image.fromarray(np.uint8(np.round(255 * (values - low) / (span or 1))))
    image.thumbnail((THUMBNAIL, THUMBNAIL))
    out = io.BytesIO()
    image.save(out, "PNG")
    return base64.b64encode(out.getvalue()).decode()


def sampler_of(plan: Plan, number: int) -> BaseSampler:
    """The sampler of a batch, seeded by it."""
    seed = int(np.random.SeedSequence([plan.seed, number]).generate_state(1)[0])
    if plan.sampler == "random":
        return RandomSampler(seed)
    if plan.sampler == "nsga":
        return NSGAIISampler(population_size=plan.batch, seed=seed)
    return TPESampler(seed=seed, n_startup_trials=2 * plan.batch, multivariate=True)


def distribution(values: list[Any] | tuple[Any, Any]) -> BaseDistribution:
    """Optuna's distribution of a key's values; of frequencies and others over a decade, logarithmic."""
    if isinstance(values, list):
        return CategoricalDistribution(values)
    low, high = values
    log = low > 0 and high / low >= 10
    if isinstance(low, int) and isinstance(high, int):
        return IntDistribution(low, high, log=log)
    return FloatDistribution(low, high, log=log)


def oriented(figures: Sequence[Mapping[str, float]], objectives: Sequence[str]) -> npt.NDArray[np.float64]:
    """Objectives of points (points, objectives), each the better the smaller."""
    signs = [-1.0 if name in MORE else 1.0 for name in objectives]
    return np.array([[s * f[n] for s, n in zip(signs, objectives, strict=True)] for f in figures]).reshape(
        -1, len(signs)
    )


def undominated(points: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """Which points no other is as good as in every objective and better in one; of equal points all."""
    as_good = np.all(points[None] <= points[:, None], axis=2)
    better = np.any(points[None] < points[:, None], axis=2)
    return ~np.any(as_good & better, axis=1)


def importances(findings: Findings, objective: str) -> dict[str, float]:
    """What each key is worth for an objective, of 1 together, by PED-ANOVA of the points in the small scene.

    Empty for fewer than two points that differ.
    """
    plan, distributions = findings.plan, {name: distribution(values) for name, values in findings.plan.space.items()}
    study = optuna.create_study(direction="maximize" if objective in MORE else "minimize")
    for row in findings.rows:
        record = row.small if plan.multi else row.full
        if record:
            value = record["figures"][objective]
            study.add_trial(optuna.trial.create_trial(value=value, params=row.values, distributions=distributions))
    values = [trial.value for trial in study.trials]
    if len(set(values)) < 2:
        return {}
    evaluator = optuna.importance.PedAnovaImportanceEvaluator()
    return dict(optuna.importance.get_param_importances(study, evaluator=evaluator))


def dominated_share(points: npt.NDArray[np.float64], low: npt.ArrayLike, high: npt.ArrayLike) -> float:
    """Part of the box low..high that ``points`` (points, objectives) dominate, by 20,000 fixed places in it."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    places = low + np.random.default_rng(59).random((20000, len(low))) * (high - low)
    covered = np.zeros(len(places), bool)
    for point in points:
        covered |= (point <= places).all(1)
    return float(covered.mean())
