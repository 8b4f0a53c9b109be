"""One run of `talbot recognize`: settings of its table and curves, evaluated, and the summary."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from talbot.base.files import atomic
from talbot.base.jobs import Job
from talbot.base.jobs import run as run_jobs
from talbot.imaging.recognize import chip, gestures, intensity, pose, study, wake
from talbot.imaging.recognize.data import Pictures, load
from talbot.imaging.recognize.study import CURVES, FREE, FRONTS, WHOLE, Point, Setting
from talbot.models.parameters import ParameterError, check_choice
from talbot.models.recognition.network import SMALLEST
from talbot.models.recognition.optics import Display, phase_types

STORE = Path("parts")  # of the results' folder: kept parts of a run
SAMPLE = 2  # pictures that the Verilog reads
WAKE, GESTURES, INTENSITY, POSE = TASKS = "wake", "gestures", "intensity", "pose"  # with pictures of their own
SOME = 600  # pictures of a curve's point


@dataclass(frozen=True, eq=False)
class Study:
    """Settings of a run.

    fronts: of the table, the first is the headline's. base: of all settings. curves: of `study.CURVES` and TASKS. some:
    pictures of a curve's point. draws: of random types. verilog: whether the chip's Verilog reads a sample.
    """

    data: Pictures
    fronts: tuple[str, ...]
    base: Setting
    curves: tuple[str, ...] = ()
    some: int = SOME
    draws: int = 100
    verilog: bool = True
    workers: int = -1

    def __post_init__(self) -> None:
        for front in self.fronts:
            check_choice("front", front, FRONTS)
        for name in self.curves:
            check_choice("curves", name, (*CURVES, *TASKS))
        if self.base.classifier == "shipped":
            raise ParameterError("classifier = 'shipped': must be kernel, lenet or binary")
        if not self.fronts or len(set(self.fronts)) != len(self.fronts):
            raise ParameterError(f"front = {','.join(self.fronts)!r}: must be different ones of {', '.join(FRONTS)}")
        Display(self.base.sensor, self.data.images.shape[1:], self.base.scale)  # fits


@dataclass(frozen=True, eq=False)
class Recognition:
    """Measurements. rows: of the table by name. lines: of each curve, (point, result). alarms: by contrast.

    gestures: rows by name. intensity: by collection of pictures. pose: rows by name, and pixels.
    """

    study: Study
    rows: Mapping[str, dict[str, Any]]
    lines: Mapping[str, Mapping[str, list[tuple[Point, dict[str, Any]]]]]
    alarms: Mapping[str, dict[str, Any]]
    gestures: Mapping[str, dict[str, Any]]
    intensity: Mapping[str, dict[str, Any]]
    pose: Mapping[str, Any]
    summary: dict[str, Any]


def measure(task: Study, folder: Path) -> Recognition:
    """Evaluate all of ``task``; parts that are ready are kept in ``folder``. Raises ParameterError, ToolError."""
    start, base, data = perf_counter(), task.base, task.data
    lead = task.fronts[0]
    chosen = {front: replace(base, front=front) for front in task.fronts}
    if "asp" in chosen and task.curves:  # one sensor in its modes
        limits = (max(base.threshold // 2, 1), min(2 * base.threshold, 127))
        chosen |= {f"asp_{limit}": replace(base, front="asp", threshold=limit) for limit in limits}
        chosen[WHOLE] = replace(base, front=WHOLE)
    rows = study.run(chosen, data, folder, "front", task.workers)
    free = {"image": replace(base, front="image")} if "image" not in task.fronts else {}
    free |= {name: replace(base, front=name, bytes=rows[lead]["bytes"]) for name in FREE}
    if study.image_size(free["same_bytes"], data.images.shape[1:]) < SMALLEST:
        free["same_bytes"] = replace(free["same_bytes"], classifier="kernel")
    if as_trained(task):
        free["shipped"] = Setting(classifier="shipped", seeds=1)
    if base.classifier != "kernel":
        free["learned"] = replace(base, front="learned")
    rows |= study.run(free, data, folder, "baseline", task.workers)
    rows = {name: study.figures(row) for name, row in rows.items()}
    lines = _curves(task, folder)
    tasks = _tasks(task, folder)
    alarms, moves, recovered = tasks[WAKE], tasks[GESTURES].get(GESTURES, {}), tasks[INTENSITY]
    angles = tasks[POSE].get(POSE, {})
    sample = _sample(task) if task.verilog else None
    summary = _summary(task, rows, sample) | {
        "curves": {
            name: {
                label: [[p.x, r["accuracy"], r["accuracy_std"]] for p, r in points]
                for label, points in by_label.items()
            }
            for name, by_label in lines.items()
        },
        "wake_auc": {
            contrast: {name: row["auc"] for name, row in detectors.items()} for contrast, detectors in alarms.items()
        },
        "gestures": moves,
        "intensity": {name: result["rows"] for name, result in recovered.items()},
        "pose": angles.get("rows", {}),
        "seconds": perf_counter() - start,
    }
    return Recognition(task, rows, lines, alarms, moves, recovered, angles, summary)


def as_trained(task: Study) -> bool:
    """Return whether pictures, split and setting are those of the shipped weights' training.

    On a part of the digits they would be tested with pictures of their training.
    """
    whole = load("digits")
    same = task.data.test is None and np.array_equal(task.data.images, whole.images)
    return same and replace(task.base, seeds=Setting.seeds) == Setting()


def _curves(task: Study, folder: Path) -> dict[str, dict[str, list[tuple[Point, dict[str, Any]]]]]:
    named = study.curves(task.base, task.curves, task.draws)
    places = {
        f"{name}-{i}-{point.x:g}": (name, label, point)
        for name, by_label in named.items()
        for i, (label, points) in enumerate(by_label.items())
        for point in points
    }
    settings = {key: point.setting for key, (_, _, point) in places.items()}
    results = study.run(settings, task.data.part(task.some), folder, "curve", task.workers)
    out: dict[str, dict[str, list[tuple[Point, dict[str, Any]]]]] = {}
    for key, (name, label, point) in places.items():
        out.setdefault(name, {}).setdefault(label, []).append((point, study.figures(results[key])))
    return out


def _tasks(task: Study, folder: Path) -> dict[str, dict[str, Any]]:
    """Results of the tasks: of each, by contrast or by collection of pictures."""
    base, seed = task.base, task.base.seed
    calls: dict[tuple[str, str], tuple[Callable[..., Any], tuple[Any, ...], str]] = {}
    if GESTURES in task.curves:
        calls[GESTURES, GESTURES] = gestures.classify, (base, min(task.some, gestures.CLIPS)), str(task.some)
    if POSE in task.curves:
        calls[POSE, POSE] = pose.regress, (base, min(task.some, pose.HEADS)), str(task.some)
    if INTENSITY in task.curves:
        for pictures in intensity.collections(task.data.part(task.some)):
            calls[INTENSITY, pictures.name] = intensity.recover, (base, pictures), pictures.digest
    if WAKE in task.curves:
        for contrast in wake.CONTRASTS:
            calls[WAKE, f"{contrast:g}"] = wake.detect, (base.sensor, contrast, seed), ""
    jobs = [Job("-".join(name), call, arguments, (base.text, key)) for name, (call, arguments, key) in calls.items()]
    out: dict[str, dict[str, Any]] = {name: {} for name in TASKS}
    for (name, part), result in zip(calls, run_jobs(jobs, folder, "task", task.workers), strict=True):
        out[name][part] = result
    return out


def _sample(task: Study) -> dict[str, int]:
    """Compare the bytes of the Verilog with the golden chip's, for frames of the first front and of those by optics."""
    base, shape, sums = task.base, task.data.images.shape[1:], Counter[str]()
    settings = [replace(base, front=front) for front in task.fronts]
    for setting in (s for s in settings if s.by_optics or s is settings[0]):
        optics = study.out_of_focus(base.sensor, shape, base.scale, base.blur)
        display = optics if setting.by_optics else study.in_focus(base.sensor, shape)
        radiance = task.data.radiance[:SAMPLE]
        sums.update(chip.verify(display, radiance, setting.mode, base.threshold, base.noise, base.seed))
    return dict(sums)


def _summary(task: Study, rows: Mapping[str, dict[str, Any]], sample: dict[str, int] | None) -> dict[str, Any]:
    lead, base, data = rows[task.fronts[0]], task.base, task.data
    splits = [data.split(seed) for seed in range(base.seed, base.seed + base.seeds)]
    free = {name: row for name, row in rows.items() if name not in task.fronts}
    return {
        "data": data.name,
        "pictures": len(data.labels),
        "trained_on": len(splits[0][0]),
        "tested_on": len(splits[0][1]),
        "classes": data.classes,
        "size": list(data.images.shape[1:]),
        "types": len(phase_types(base.sensor)),
        "front": task.fronts[0],
        "classifier": base.classifier,
        "scale": base.scale,
        "blur": base.blur,
        "threshold": base.threshold,
        "noise": base.noise,
        "seed": base.seed,
        "seeds": base.seeds,
        **{key: lead[key] for key in ("accuracy", "accuracy_std", "energy_uj", "bytes")},
        **{key: lead[key] for key in ("flops_first_layer", "flops_total", "network_uj")},
        "baselines": {
            name: {key: row[key] for key in ("accuracy", "accuracy_std", "bytes")} for name, row in free.items()
        },
        "rows": dict(rows),
        "verilog": sample,
        "stream_mismatches": sample["mismatches"] if sample else 0,
    }


def write_weights(task: Study, path: Path) -> None:
    """Train the lenet of the first front on the split of the first seed, and write it. Raises ParameterError."""
    base, data = replace(task.base, front=task.fronts[0], classifier="lenet"), task.data
    channels, (chosen, _) = study.see(base, data.radiance).channels, data.split(base.seed)
    net = study.network(base, channels.shape[1:], data.classes, base.seed)
    net.train(channels[chosen], data.labels[chosen], base.epochs, base.shift)
    with atomic(path) as part, part.open("wb") as file:
        net.save(file)
