"""A process's cells measured again at its corners, for the tables that are shipped."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.files import check_folder
from talbot.base.paths import RESULTS
from talbot.base.progress import Steps
from talbot.base.steps import Runner
from talbot.flow.layout.steps.library import Library
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.timing import Timing, TimingParameters
from talbot.flow.layout.tables import SHIPPED, write
from talbot.platforms.layout import layout_platform
from talbot.platforms.processes import PROCESSES


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot layout-timing`."""
    add = parser.add_argument
    add("--layouts", type=Path, default=RESULTS / "layout", help="folder of the layouts, as of make layout")
    add("--out", type=Path, default=RESULTS / "layout" / "timing", help="folder of the tables")


def run(options: Namespace) -> int:
    """Measure every cell at every corner in ngspice, and write the tables that a layout takes if they are shipped."""
    pdk = PROCESSES[0]  # the one whose device models are here
    check_folder("out", options.out)
    corners = layout_platform(pdk).corners
    steps = Library(PdkParameters(pdk)), Timing(TimingParameters(pdk, corners, measured=True))
    with Steps([step.name for step in steps], lines=True) as bar:
        runner = Runner(options.layouts / "shared", {}, bar.note)
        _, found = (runner.run(step) for step in steps)
    libraries = {corner: runner.paths[f"timing.{corner}"] for corner in corners}
    metrics = found["metrics"]
    write(options.out, pdk, metrics["key"], libraries, metrics["simulations"])
    print(f"{pdk}: {metrics['cells']} cells, {metrics['simulations']} simulations, {found['wall_s']:.0f} s")
    print(f"look at {options.out}; {SHIPPED.relative_to(SHIPPED.parents[3])} has those that layouts take")
    return 0
