"""All steps of the verification, then build/verify/report.html and summary.json.

The exit status is 1 when a figure is beyond its limit in verif/report/limits.json, a step is missing or fails, or a
point is open. A killed run resumes: the steps keep their results.
"""

import json
import os
from argparse import ArgumentParser, Namespace
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from time import perf_counter

from talbot.base.check import work_begins
from talbot.base.command import failures
from talbot.base.files import marked, staged
from talbot.verif.report import document, limits
from talbot.verif.report.merge import summarize
from talbot.verif.report.page import render
from talbot.verif.report.steps import STEPS, Outcome, read_step, run_step
from talbot.verif.results import OUT, SEED, BlockResults, seed_of

BY_NAME = {step.name: step for step in STEPS}


def outcomes(chosen: Collection[str], out: Path, seed: int = SEED) -> list[Outcome]:
    """Run the steps named in ``chosen`` and read the kept results of the others."""
    done = []
    for number, step in enumerate(STEPS, 1):
        if step.name not in chosen:
            by_block, problem = read_step(step, out)
            done.append(Outcome(step, 0.0, problem, by_block))
            continue
        print(f"\nverify {number}/{len(STEPS)}: {step.title}", flush=True)
        done.append(run_step(step, out, seed))
        if done[-1].problem:
            failures([done[-1].problem])
    return done


SEED_OPTION = seed_of("of tests, benches and fuzz")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot verify`."""
    parser.add_argument(
        "--steps",
        nargs="+",
        choices=BY_NAME,
        metavar="NAME",
        help=f"run these alone, and read the kept results of the others; of {', '.join(BY_NAME)}",
    )
    parser.add_argument("--read", action="store_true", help="run nothing: report on the kept results")
    SEED_OPTION.add(parser)
    parser.add_argument("--out", type=Path, default=OUT, help="folder of the results and the report")
    parser.add_argument("--document", type=Path, help="Markdown file whose table of steps to write")


def run(options: Namespace) -> int:
    """Return 0, 1 where a point is open."""
    start, out = perf_counter(), options.out
    seed = SEED_OPTION.value(options)
    held = limits.read()
    if options.document:
        marked(options.document, "steps")
    work_begins()
    out.mkdir(parents=True, exist_ok=True)
    load = document.load()
    done = outcomes([] if options.read else options.steps or list(BY_NAME), out, seed)
    runs = document.record(done, out, load)
    if options.document:
        document.put(options.document, done, runs)
    summary = summarize([outcome.by_block for outcome in done])
    problems = [o.problem for o in done if o.problem]
    fallen = limits.fallen(summary, held)
    seconds = perf_counter() - start
    with staged(out) as part:
        (part / "summary.json").write_text(
            json.dumps(summary, indent=1, allow_nan=False, default=asdict) + "\n", encoding="utf-8"
        )
        (part / "report.html").write_text(render(summary, done, problems, fallen, held, seconds), encoding="utf-8")
    return print_failures(summary, [*problems, *fallen], out)


def print_failures(summary: Mapping[str, BlockResults], problems: Sequence[str], out: Path) -> int:
    """Print the problems and open points; returns the exit status."""
    points = [f"{block}: {point}" for block, entry in summary.items() for point in entry.open_points]
    bad = len(problems) + len(points)
    status = failures([*problems, *points])
    print(f"{'verified' if not bad else f'{bad} points are open'}: {os.path.relpath(out / 'report.html')}")
    return status
