"""Line, toggle, branch, expression, state machine and functional coverage: build/verify/coverage.json.

A block's own tests are recorded and replayed into its exported Verilog. Exit status 1 where anything is below 100 %.
"""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.jobs import Job
from talbot.base.jobs import run as run_jobs
from talbot.base.records import from_json
from talbot.models.parameters import ParameterError
from talbot.rtl.replay import load
from talbot.rtl.tops import TOPS
from talbot.verif.coverage.constants import constants
from talbot.verif.coverage.measure import Measurement, measure
from talbot.verif.coverage.testplan import TestPlan, folder_of, load_plan, plan_file
from talbot.verif.coverage.traces import recorded
from talbot.verif.coverage.verdict import Verdict, judge
from talbot.verif.results import OUT, BlockResults, write_step


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
    measurements: dict[str, list[Measurement]] = {}
    for (block, _), result in zip(jobs, run_jobs([job for _, job in jobs], store, "coverage"), strict=True):
        measurements.setdefault(block, []).append(from_json(Measurement, result))
    proven = run_jobs([Job(block, constants, (str(traces[block][0]),)) for block in plans], store, "constants")
    return {
        block: judge(block, plan, measurements[block], {(module, signal, bit) for module, signal, bit in bits})
        for (block, plan), bits in zip(plans.items(), proven, strict=True)
    }


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot coverage`."""
    parser.add_argument("--only", nargs="+", choices=TOPS, metavar="BLOCK", help=f"of {', '.join(TOPS)}")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of coverage.json")


def run(options: Namespace) -> int:
    """Return 0, 1 below 100 %."""
    files = {block: plan_file(folder_of(block)) for block in options.only or TOPS}
    loaded = {file: load_plan(file) for file in dict.fromkeys(files.values())}
    plans = {block: loaded[file] for block, file in files.items()}
    for block, plan in plans.items():
        if block not in plan.blocks:
            raise ParameterError(f"{files[block].name}: blocks = {plan.blocks}: must have {block}")
    verdicts = measured(plans, options.out / "coverage")
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
        print(f"{block}: {figures}; {verdict.constant} constant, {verdict.excluded} excluded")
        for text in verdict.errors + verdict.missing:
            print(f"  {text}")
    return int(not all(verdict.complete for verdict in verdicts.values()))
