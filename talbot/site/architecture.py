"""The page of the architecture: floors from pyproject.toml, blocks from the elaborated RTL, machines from test plans.

The transitions are those that coverage finds in the RTL, all of them and no other (verif/coverage).
"""

import tomllib
from collections import defaultdict
from pathlib import Path
from typing import Any

from pymtl3.dsl.Connectable import Const

from talbot.base.paths import ROOT
from talbot.models.parameters import SensorParameters
from talbot.rtl.tops import build_top
from talbot.site import diagrams
from talbot.verif.coverage.testplan import TestPlan, load_plan

CHIP, PINS = "AspChip", "pins"
CLOCKED = "clk", "reset"  # to every block; their resets come from `resets`


def write(source: Path) -> None:
    """Write architecture.md."""
    (source / "architecture.md").write_text("\n".join([*_floors(), *_blocks(), *_machines()]) + "\n", encoding="utf-8")


def _figure(svg: str) -> list[str]:
    return ["```{raw} html", f"<figure>{svg}</figure>", "```", ""]


def layers() -> dict[str, list[str]]:
    """Title of each contract of layers -> its layers, the highest first."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    return {contract["name"]: contract["layers"] for contract in contracts if contract["type"] == "layers"}


def _floors() -> list[str]:
    lines = ["# Architecture", "", "Drawn from the code by `make site`.", "", "## The floor plan", ""]
    lines += ["A folder imports from those below it alone; `make lint` and `make test` check it.", ""]
    for title, order in layers().items():
        lines += [f"### {title}", "", *_figure(diagrams.floors(order))]
    return lines


def connections(top: Any) -> tuple[dict[str, str], dict[tuple[str, str], int]]:
    """Blocks in an elaborated component (name -> class), and the bits from one to another, `PINS` for its ports.

    A signal counts once for each block that reads it, however many of the block's parts do.
    """

    def block(signal: Any) -> str:
        host = signal.get_host_component()
        while host is not top and host.get_parent_object() is not top:
            host = host.get_parent_object()
        return PINS if host is top else host._dsl.my_name

    bits: dict[tuple[str, str], int] = defaultdict(int)
    for writer, signals in top.get_all_value_nets():
        if isinstance(writer, Const):
            continue
        origin = block(writer)
        readers = {block(signal) for signal in signals if signal._dsl.my_name not in CLOCKED}
        for reader in readers - {origin}:
            bits[origin, reader] += writer._dsl.Type.nbits
    blocks = {PINS: type(top).__name__}
    children = sorted(top.get_child_components(), key=lambda child: list(vars(top)).index(child._dsl.my_name))
    return blocks | {child._dsl.my_name: type(child).__name__ for child in children}, dict(bits)


def _blocks() -> list[str]:
    top = build_top(CHIP, SensorParameters())
    top.elaborate()
    lines = [
        "## The chip's blocks",
        "",
        f"The components of [{CHIP}](rtl/asp_chip/README.md) for the default sensor, and",
    ]
    lines += [
        "how many bits lead from the block of a row to that of a column. Clock and resets are left out; `pins` are"
    ]
    lines += ["the chip's own ports and the few gates between blocks.", ""]
    return lines + _figure(diagrams.matrix(*connections(top)))


def plans() -> list[TestPlan]:
    """Return the test plans of all blocks."""
    return [load_plan(path) for path in sorted((ROOT / "verif").glob("*.testplan.yaml"))]


def _machines() -> list[str]:
    lines = [
        "## State machines and promises",
        "",
        "Of every block's test plan (`verif/<block>.testplan.yaml`): its state",
    ]
    lines += [
        "machines with the codes in the RTL and every transition outside reset, and what its README promises, with"
    ]
    lines += [
        "the cover points that show that it is tried and the tests that check it. `make coverage` requires each.",
        "",
    ]
    for plan in plans():
        lines += [f"### [{', '.join(plan.blocks)}](rtl/{plan.folder}/README.md)", ""]
        for machine in plan.machines:
            where = f" of {', '.join(machine.blocks)}" if machine.blocks else ""
            registers = ", ".join(f"`{name}`" for name in dict(machine.registers))
            lines += [f"{registers}{where}:", "", *_figure(diagrams.machine(machine.states, machine.transitions))]
        for promise in plan.promises:
            cover, tests = (", ".join(f"`{name}`" for name in names) for names in (promise.cover, promise.tests))
            lines.append(f"- {promise.promise}.<br>Cover points: {cover}. Tests: {tests}.")
        lines.append("")
    return lines
