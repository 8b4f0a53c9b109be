"""All steps of the verification, then build/verify/report.html and summary.json.

The exit status is 1 when a figure is beyond its limit in verif/report/limits.json, a step is missing or fails, or a
point is open. A killed run resumes: the steps keep their results.
"""

import argparse
import json
import os
import sys
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from time import perf_counter

from base.files import staged
from models.parameters import ParameterError
from verif.results import OUT, BlockResults

from . import limits
from .merge import summarize
from .page import render
from .steps import STEPS, Outcome, read_step, run_step

BY_NAME = {step.name: step for step in STEPS}


def outcomes(chosen: Collection[str], out: Path) -> list[Outcome]:
    """Run the steps named in ``chosen`` and read the kept results of the others."""
    done = []
    for number, step in enumerate(STEPS, 1):
        if step.name not in chosen:
            by_block, problem = read_step(step, out)
            done.append(Outcome(step, 0.0, problem, by_block))
            continue
        print(f"\nverify {number}/{len(STEPS)}: {step.title}", flush=True)
        done.append(run_step(step, out))
        if done[-1].problem:
            print(f"verif.report: {done[-1].problem}", file=sys.stderr, flush=True)
    return done


def arguments() -> argparse.ArgumentParser:
    """Return the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m verif.report", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--steps",
        nargs="+",
        choices=BY_NAME,
        metavar="NAME",
        help=f"run these alone, and read the kept results of the others; of {', '.join(BY_NAME)}",
    )
    parser.add_argument("--read", action="store_true", help="run nothing: report on the kept results")
    return parser


def main(argv: Sequence[str] | None = None, out: Path = OUT) -> int:
    """Return 0, 1 where a point is open, 2 where no report could be written."""
    options = arguments().parse_args(argv)
    start = perf_counter()
    try:
        held = limits.read()
        out.mkdir(parents=True, exist_ok=True)
        done = outcomes([] if options.read else options.steps or list(BY_NAME), out)
        summary = summarize([outcome.by_block for outcome in done])
        problems = [o.problem for o in done if o.problem]
        fallen = limits.fallen(summary, held)
        seconds = perf_counter() - start
        with staged(out) as part:
            (part / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False, default=asdict) + "\n")
            (part / "report.html").write_text(render(summary, done, problems, fallen, held, seconds))
    except (ParameterError, OSError) as error:
        print(f"verif.report: {error}", file=sys.stderr)
        return 2
    return print_failures(summary, [*problems, *fallen], out)


def print_failures(summary: Mapping[str, BlockResults], problems: Sequence[str], out: Path) -> int:
    """Print the problems and open points; returns the exit status."""
    points = [f"{block}: {point}" for block, entry in summary.items() for point in entry.open_points]
    for line in (*problems, *points):
        print(f"verif.report: {line}", file=sys.stderr)
    bad = len(problems) + len(points)
    print(f"{'verified' if not bad else f'{bad} points are open'}: {os.path.relpath(out / 'report.html')}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
