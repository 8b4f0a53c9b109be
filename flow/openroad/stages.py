"""The stages in their order: each a script in tcl/, run by Yosys or OpenROAD in the design's folder."""

import os
import re
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from talbot.base.liberty.read import without
from talbot.base.steps.alone import alone
from talbot.base.tools import ToolError, finish
from talbot.models.parameters import ParameterError
from talbot.platforms.openroad import WIRES, OpenRoadPlatform

from .netlists import write_synthesized

SCRIPTS = Path(__file__).parent / "tcl"
# Threads that wait give their core away: beside other jobs, placement of the divider took 15 times its CPU time
ENVIRONMENT = {"OMP_WAIT_POLICY": "passive"}
INSTALL = "https://openroad.readthedocs.io (packages, source) or a LibreLane or flow-scripts container"


@dataclass(frozen=True)
class Stage:
    """A script and its log. gives: file without which it failed. corner: of the wires, or ''."""

    name: str
    gives: str
    corner: str = ""

    @property
    def log(self) -> str:
        """File name of its log."""
        return f"{self.name}.{self.corner}.log" if self.corner else f"{self.name}.log"

    def command(self) -> list[str]:
        """Its program and arguments."""
        program = "yosys -q -c" if self.name == "synth" else "openroad -no_init -no_splash -threads max -exit"
        return [*program.split(), f"{self.name}.tcl"]


def stages(tech: OpenRoadPlatform, wires: Sequence[str] = WIRES) -> list[Stage]:
    """Every Stage. wires: corners of parasitics that the PDK has."""
    databases = [Stage(name, f"{name}.odb") for name in ("floorplan", "power", "place", "cts", "repair", "route")]
    extraction = [Stage("extract", f"{corner}.spef", corner) for corner in wires]
    timing = [Stage("sta", f"{corner}.{tech.corners[-1]}.sdf", corner) for corner in wires]
    return [Stage("synth", "netlist.json"), *databases, Stage("finish", "final.v"), *extraction, *timing]


def wire_corners(tech: OpenRoadPlatform, root: Path) -> list[str]:
    """Corners of parasitics for which the PDK in ``root`` has rules."""
    return [name for name in WIRES if any((root / path).is_file() for path in tech.rcx_rules[name])]


def pdk_root(tech: OpenRoadPlatform, environment: Mapping[str, str] = os.environ) -> Path:
    """The folder PDK_ROOT, every file of the process there. Raises ParameterError."""
    root = environment.get("PDK_ROOT", "")
    if not root:
        install = f"pip install ciel; ciel enable --pdk-family {tech.name} <version>"
        raise ParameterError(f"PDK_ROOT = '': must be the folder of an installed PDK ({install})")
    needed = [(path,) for path in (*tech.liberty.values(), tech.tech_lef, tech.cell_lef, tech.cell_gds)]
    for paths in (*needed, tech.rcx_rules[WIRES[0]]):
        if not any((Path(root) / path).is_file() for path in paths):
            raise ParameterError(f"PDK_ROOT = {root}: must hold {' or '.join(paths)}")
    return Path(root)


def missing_tools() -> list[str]:
    """Of the programs that the stages call, those not on PATH."""
    return [tool for tool in ("yosys", "openroad") if not shutil.which(tool)]


def run(folder: Path, top: str, tech: OpenRoadPlatform, root: Path, note: Callable[[str], None]) -> dict[str, float]:
    """Run every stage of the module ``top`` in ``folder``; returns the figures by name, of its logs.

    They are the lines 'TALBOT name value', and 'seconds.<stage>' and 'mib.<stage>' (peak memory) of each. note: called
    with each stage's name. Raises ToolError with the last lines of a stage that failed.
    """
    text = (root / tech.liberty[tech.corners[0]]).read_text()  # cells are chosen by their slowest delays
    (folder / "synthesis.lib").write_text(without(text, tech.dont_use))
    found = {}
    for stage in stages(tech, wire_corners(tech, root)):
        name = stage.log.removesuffix(".log")
        note(name)
        begin = time.perf_counter()
        (folder / stage.gives).unlink(missing_ok=True)
        variables = ENVIRONMENT | {"PDK_ROOT": str(root), "CORNER": stage.corner}
        done, peak = alone(finish, stage.command(), variables, folder, None, folder / stage.log)
        written = (folder / stage.gives).is_file()
        if done.returncode or not written:
            tail = "\n".join(done.stdout.strip().splitlines()[-10:])
            state = f"status {done.returncode}, {stage.gives} {'written' if written else 'not written'}"
            raise ToolError(f"{stage.command()[0]} {stage.name}: {state}:\n{tail}")
        if stage.name == "synth":
            write_synthesized(folder, top, tech)
        found |= {key: float(value) for key, value in re.findall(r"^TALBOT (\S+) (\S+)$", done.stdout, re.M)}
        found |= {f"seconds.{name}": round(time.perf_counter() - begin, 1), f"mib.{name}": peak}
    return found
