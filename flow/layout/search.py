"""The search for the smallest area whose layout keeps all design rules."""

import re
from collections.abc import Sequence

from talbot.base.steps import Runner, Step, StepError
from talbot.base.steps.versions import version
from talbot.flow.layout.chain import Signoff, all_steps, checks, floors, signoff_steps, stages, synthesis_steps
from talbot.flow.layout.design import Design
from talbot.flow.layout.options import Options
from talbot.flow.layout.report.metrics import Attempt
from talbot.flow.layout.steps.stage import Stage
from talbot.platforms.layout import layout_platform

FIRST = "floorplan", "power"  # stages that no other outline helps
FULL = re.compile(r"cells fill ([\d.]+) % of the core after repair: must be at most ([\d.]+) %")


def lay_out_smallest(
    design: Design, options: Options, runner: Runner, signoff: Signoff = signoff_steps
) -> list[Attempt]:
    """Run all steps with ``runner``; the attempts, of which the last closes if any does.

    An attempt closes when every net is routed and no rule of design or antennas is broken. signoff: function
    (design, options) -> the steps after it; those that need no more than there is begin beside the steps before. Raises
    ToolError for a missing tool, before anything runs, and StepError where no attempt can close.
    """
    version(f"python {layout_platform(options.pdk).wheel}")
    for step in all_steps(design, options, signoff):
        for tool in step.tools:
            version(tool)
    steps = signoff(design, options)
    with runner.beside(steps):
        for step in synthesis_steps(design, options):
            runner.run(step)
        tried = _attempted(design, options, runner)
        if tried[-1].rules_broken == 0:
            runner.run_all(steps)
    return tried


def _attempted(design: Design, options: Options, runner: Runner) -> list[Attempt]:
    """Place and route in OpenROAD until an attempt closes: the attempts.

    Outlines that the cells of an earlier attempt would overfill are skipped. Raises StepError where no attempt can
    close: the first stages do not run.
    """
    tried, known, highest = [], dict(runner.paths), 1.0
    for floor in floors(design, options):
        if floor.utilization > highest:
            continue
        runner.paths = dict(known)
        attempt = Attempt(floor.utilization, floor.aspect)
        tried.append(attempt)
        *places, out = stages(design, options, floor)
        for stage in places:
            metrics = runner.run(stage)["metrics"]
            if not isinstance(stage, Stage):
                continue
            attempt.again += [f"{stage.name}: {metrics['again']}"] if metrics["again"] else []
            if metrics["stopped"]:
                attempt.stopped = f"{stage.name}: {metrics['stopped']}"
                if stage.name in FIRST:
                    raise StepError(attempt.stopped)
                break
            attempt.open_nets = metrics.get("open_nets")
        if attempt.stopped:
            runner.note(f"utilization {floor.utilization:g}: {attempt.stopped}")
            highest = fitting(floor.utilization, attempt.stopped)
            continue
        attempt.utilization = runner.run(out)["metrics"]["utilization"]
        attempt.rules_broken = broken_rules(checks(options), runner)
        if not attempt.open_nets and not attempt.rules_broken:
            break
    return tried


def fitting(utilization: float, stopped: str) -> float:
    """Return the utilization at which the cells of a stopped attempt fit the core; 1 where it did not overfill it.

    utilization: of that attempt. A larger core takes no fewer cells: its nets are longer.
    """
    if not (full := FULL.search(stopped)):
        return 1.0
    filled, most = map(float, full.groups())
    return utilization * most / filled


def broken_rules(steps: Sequence[Step], runner: Runner) -> int:
    """Run the checks; how many design rules, densities and antennas are broken."""
    pairs = zip(steps, runner.run_all(steps), strict=True)
    return sum(record["metrics"].get(f"{step.name}_violations", 0) for step, record in pairs)
