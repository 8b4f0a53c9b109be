"""Line, toggle, branch, state machine and functional coverage: build/verify/coverage.json.

A block's own tests are recorded and replayed into its exported Verilog. Exit status 1 where anything is below 100 %.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from base.jobs import Job, run
from base.records import from_json
from base.tools import ToolError
from models.parameters import ParameterError
from rtl.replay import RecordError, load
from rtl.tops import TOPS
from verif.results import OUT, BlockResults, write_step

from .measure import Measurement, measure
from .testplan import TestPlan, folder_of, load_plan, plan_file
from .traces import recorded
from .verdict import Verdict, judge


def measure_jobs(plans: dict[str, TestPlan], traces: dict[str, list[Path]]) -> list[tuple[str, Job]]:
    """Return (block, Job) for each trace."""
    jobs = []
    for block, paths in traces.items():
        plan = plans[block]
        registers = tuple(machine.registers for machine in plan.machines_of(block))
        for path in paths:
            name = load(path, cycles=False).name
            arguments = str(path), plan.folder, registers, plan.cover
            inputs = path, path.with_suffix(".trace"), registers, plan.cover
            jobs.append((block, Job(f"{block}-{name}", measure, arguments, inputs)))
    return jobs


def measured(plans: dict[str, TestPlan], store: Path) -> dict[str, Verdict]:
    """Return the Verdict by block. plans: by block. store: folder of kept results."""
    traces = recorded(plans, store.parent / "traces")
    jobs = measure_jobs(plans, traces)
    found: dict[str, list[Measurement]] = {}
    for (block, _), result in zip(jobs, run([job for _, job in jobs], store, "coverage"), strict=True):
        found.setdefault(block, []).append(from_json(Measurement, result))
    return {block: judge(block, plan, found[block]) for block, plan in plans.items()}


def arguments() -> argparse.ArgumentParser:
    """Return the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m verif.coverage", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", choices=TOPS, metavar="BLOCK", help=f"of {', '.join(TOPS)}")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of coverage.json; default: build/verify")
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Return 0, 1 below 100 %, 2 where nothing could be measured."""
    options = arguments().parse_args(argv)
    try:
        files = {block: plan_file(folder_of(block)) for block in options.only or TOPS}
        loaded = {file: load_plan(file) for file in dict.fromkeys(files.values())}
        plans = {block: loaded[file] for block, file in files.items()}
        for block, plan in plans.items():
            if block not in plan.blocks:
                raise ParameterError(f"{files[block].name}: blocks = {plan.blocks}: must have {block}")
        verdicts = measured(plans, options.out / "coverage")
    except (ParameterError, ToolError, RecordError, OSError) as error:
        print(f"verif.coverage: {error}", file=sys.stderr)
        return 2
    write_step(
        "coverage",
        {
            block: BlockResults(coverage=v.coverage, excluded=v.excluded, open_points=v.errors + v.missing)
            for block, v in verdicts.items()
        },
        options.out,
    )
    for block, verdict in verdicts.items():
        figures = ", ".join(
            f"{kind} {'-' if value is None else f'{value:g} %'}" for kind, value in verdict.coverage.items()
        )
        print(f"{block}: {figures}; {verdict.excluded} points excluded")
        for text in verdict.errors + verdict.missing:
            print(f"  {text}")
    return int(not all(verdict.complete for verdict in verdicts.values()))


if __name__ == "__main__":
    sys.exit(main())
