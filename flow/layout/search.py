"""The search for the smallest area whose layout keeps all design rules."""

from talbot.base.steps import Runner
from talbot.base.steps.versions import version
from talbot.models.parameters import ParameterError
from talbot.platforms.coriolis import coriolis_platform

from .chain import Signoff, all_steps, attempts, routing_steps, signoff_steps, synthesis_steps
from .design import Design
from .options import Options
from .report.metrics import Attempt


def lay_out_smallest(
    design: Design, options: Options, runner: Runner, signoff: Signoff = signoff_steps
) -> list[Attempt]:
    """Run all steps with ``runner``; the attempts, of which the last closes if any does.

    An attempt closes when every net is routed and no rule of design or antennas is broken. signoff: function
    (design, options) -> the steps after it; those that need no more than there is begin beside the steps before. Raises
    ParameterError where macros find no place in any attempt, ToolError for a missing tool, before anything runs.
    """
    version(f"python {coriolis_platform(options.pdk).wheel}")
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
    """Place and route until an attempt closes: the attempts. Raises as `lay_out_smallest`."""
    tried, placed, misfit, known = [], 0, None, dict(runner.paths)
    for floorplan, place, arrange in attempts(design, options):
        runner.paths = dict(known)
        shape = floorplan.parameters
        attempt = Attempt(shape.utilization, shape.aspect, arrange.parameters.spread)
        tried.append(attempt)
        try:
            attempt.utilization = runner.run(floorplan)["metrics"]["utilization"]
        except ParameterError as error:
            misfit = error
            continue
        placed += 1
        found = runner.run(place)["metrics"]
        if found["stopped"] is not None:
            continue
        if runner.run(arrange)["metrics"]["stopped"] is not None:
            continue
        repair, route, *checks = routing_steps(design, options)
        runner.run(repair)
        attempt.open_nets = runner.run(route)["metrics"]["open_nets"]
        if not attempt.open_nets:
            pairs = zip(checks, runner.run_all(checks), strict=True)
            attempt.rules_broken = sum(made["metrics"].get(f"{step.name}_violations", 0) for step, made in pairs)
            if not attempt.rules_broken:
                return tried
    if misfit and not placed:
        raise misfit
    return tried
