"""From a task to sensors: keys of sensor.toml searched for the front of error, energy, bytes, area and rate."""

import json
from argparse import ArgumentParser, Namespace
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from talbot.base.arguments import Number
from talbot.base.files import check_folder, insert, marked, staged
from talbot.base.jobs import worker_count
from talbot.base.paths import results_of
from talbot.base.sensor import HELP
from talbot.models.parameters import ParameterError, SensorParameters, check_choice, read_sensor

if TYPE_CHECKING:
    from talbot.imaging.explore.search import Findings, Plan

STORE, RANDOM = "trials.sqlite", "random.sqlite"
NUMBERS = (
    Number("lux", "illuminance of white, of edges, lightfield and polarization", 1e-3, 1e6, "500", kind=float),
    Number("trials", "points that are simulated", 1, 10**6, "40"),
    Number("seed", "of the search and of every random draw", 0, 2**31, "1"),
    Number("batch", "points that are asked for together: workers that are of use", 1, 10**4, "8"),
    Number("timeout", "s that a trial may take", 1, 10**6, "1800", kind=float),
    Number("robust", "chips of the process spread, of the point with the least error; 0: none", 0, 10**4, "0"),
)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot explore`: texts, checked by `run`."""
    add = parser.add_argument
    add("--task", default="edges", help="edges, lightfield, polarization, depth, recognition, or your file .py")
    add("--scenes", default="", help="scenes or files, with commas (default: the task's own)")
    add("--budget", default="", help="limits with commas between: 'energy_uj<20,area_mm2<10'")
    add("--objectives", default="", help="figures, with commas (default: error,energy_uj,bytes,area_mm2,frames_per_s)")
    add(
        "--keys", default="", help="keys that vary, in words: 'array.rows=96,192 threshold=4..20' (default: the task's)"
    )
    for number in NUMBERS:
        number.add(parser)
    add("--sampler", default="tpe", help="tpe, nsga or random")
    add("--full", action="store_true", help="every point in full, none in a small scene first")
    add("--baseline", action="store_true", help="also search with random points, as many, for comparison")
    add("--no-thesis", action="store_true", help="without the thesis's sensor, which takes as long as many small ones")
    add("--sensor", type=Path, help=f"of keys that do not vary: {HELP}")
    add("--workers", type=worker_count, default=1, help="processes, -1: all cores; results do not depend on them")
    add("--document", type=Path, help="also put the front between the marks of this file, named as the task")
    add("--out", type=Path, help="folder for the results (default: build/explore/<task>)")


def run(options: Namespace) -> int:
    """Search, write page, table, sensor files and summary.json, print the front."""
    folder, plan, robust = folder_and_plan(options)
    from talbot.imaging.explore import page  # Optuna: not before it is needed

    check_folder("out", folder, page.NAMES)
    mark = f"{plan.task.name} {','.join(plan.objectives)}"
    if options.document:
        marked(options.document, mark)
    findings, summary = explored(plan, folder, robust, options.baseline)
    if options.document:
        from talbot.imaging.explore.results import lines

        insert(options.document, mark, lines(findings, plan.objectives))
    _print(summary)
    print(f"  look at {folder / 'explore.html'}")
    return 0


def folder_and_plan(options: Namespace, sensor: SensorParameters | None = None) -> "tuple[Path, Plan, int]":
    """Return folder, plan, and chips of the robustness, that the options name.

    sensor: of keys that do not vary, instead of the file of the options. Raises ParameterError.
    """
    from talbot.imaging.explore.tasks import figures_of, task_of

    numbers = {number.field: number.value(options) for number in NUMBERS}
    if options.sensor:
        sensor = read_sensor(options.sensor)
    task = task_of(options.task, options.scenes, numbers["lux"], sensor)
    folder = options.out or results_of("explore") / task.name
    return folder, plan_of(task, figures_of(task), numbers, options), numbers["robust"]


def plan_of(task: Any, figures: tuple[str, ...], numbers: dict[str, Any], options: Namespace) -> "Plan":
    """The plan of checked options. Raises ParameterError."""
    from talbot.imaging.explore.budget import limits_of
    from talbot.imaging.explore.search import SAMPLERS, Plan
    from talbot.imaging.explore.space import narrowed
    from talbot.imaging.explore.task import FIGURES

    objectives = tuple(filter(None, options.objectives.split(","))) or FIGURES
    for name in objectives:
        check_choice("objectives", name, figures)
    if len(set(objectives)) != len(objectives):
        raise ParameterError(f"objectives = {options.objectives!r}: must be different")
    check_choice("sampler", options.sampler, SAMPLERS)
    return Plan(
        task,
        narrowed(task.space, options.keys),
        objectives,
        limits_of(options.budget, figures),
        numbers["trials"],
        numbers["batch"],
        numbers["seed"],
        options.sampler,
        not options.full,
        options.workers,
        numbers["timeout"],
        not options.no_thesis,
    )


def explored(plan: "Plan", folder: Path, robust: int = 0, baseline: bool = False) -> "tuple[Findings, dict[str, Any]]":
    """Search, and write the files of the results into ``folder``, all or none. Raises ParameterError, OSError."""
    if baseline and plan.sampler == "random":
        raise ParameterError("sampler = 'random': must be another with a baseline, whose points are random")
    from talbot.imaging.explore import page, results
    from talbot.imaging.explore.robust import robustness
    from talbot.imaging.explore.search import search

    findings = search(plan, folder / STORE)
    summary = results.summarize(findings, folder)
    if baseline:
        by_chance = search(replace(plan, sampler="random", thesis=False), folder / RANDOM)
        summary["baseline"] = results.shares({plan.sampler: findings, "random": by_chance})
    if robust and findings.front:
        least = min(findings.front, key=lambda row: (row.full or {})["figures"]["error"])
        summary["robustness"] = robustness(plan, least, robust)
    with staged(folder, page.NAMES) as part:
        results.write(part, findings, summary)
        page.write(part, findings, summary)
        (part / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return findings, summary


def _print(s: dict[str, Any]) -> None:
    counts, refused = s["counts"], sum(s["refused_before"].values())
    print(
        f"{s['task']}: {s['trials']} points, {counts['full']} in full, {counts['failed']} failed; "
        f"{refused} refused before any simulation"
    )
    if s["exhausted"]:
        print("  the space has no more points that keep the budget by what is known before a simulation")
    for number, reason in s["failed"].items():
        print(f"  {number} failed: {reason}")
    print(f"  {'point':8}" + "".join(f"{name:>14}" for name in s["objectives"]))
    for entry in [*([s["thesis"]] if s["thesis"] else []), *s["front"]]:
        print(f"  {entry['point']:8}" + "".join(f"{entry['figures'][name]:>14.4g}" for name in s["objectives"]))
    if s["free_error"] is not None:
        print(f"  nothing: error {s['free_error']:.4g}")
    if shares := s.get("baseline"):
        percents = ", ".join(f"{name} {100 * share:.1f} %" for name, share in shares.items())
        print(f"  dominated, of the box of all points in full: {percents}")
    if robust := s.get("robustness"):
        worst = ", ".join(f"{kind} {value:.4g}" for kind, value in robust["worst_error"].items() if value is not None)
        share = "-" if robust["yield"] is None else f"{100 * robust['yield']:.0f} %"
        print(f"  {robust['point']:04}: yield {share} of {robust['chips']} chips; worst error: {worst}")
