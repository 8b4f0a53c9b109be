"""The stages in their order: each a script in tcl/, run by Yosys or OpenROAD in the design's folder."""

import json
import os
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from talbot.base import openroad
from talbot.base.cache import digest
from talbot.base.files import staged
from talbot.base.jobs import kept
from talbot.base.liberty.read import without
from talbot.base.steps.alone import alone
from talbot.base.steps.versions import version
from talbot.base.tools import ToolError, finish
from talbot.flow.layout.steps.stage import ENVIRONMENT, figures
from talbot.flow.openroad.netlists import write_synthesized
from talbot.models.parameters import ParameterError
from talbot.platforms.openroad import WIRES, OpenRoadPlatform

TCL_YOSYS = shutil.which("yosys") or "yosys"  # the system's: the Python package has no Tcl


@dataclass(frozen=True)
class Stage:
    """A script. gives: file without which it failed. corner: of the wires, or ''."""

    name: str
    gives: str
    corner: str = ""

    @property
    def label(self) -> str:
        """Name of its log and record, without suffix."""
        return f"{self.name}.{self.corner}" if self.corner else self.name

    def command(self) -> list[str]:
        """Program and arguments."""
        script = f"{self.name}.tcl"
        return [TCL_YOSYS, "-q", "-c", script] if self.name == "synth" else openroad.command(script, "max")


def stages(tech: OpenRoadPlatform, wires: Sequence[str] = WIRES) -> list[Stage]:
    """Every Stage. wires: corners of parasitics that the PDK has."""
    names = "floorplan", "power", "place", "cts", "repair", "loads", "route", "mend"
    databases = [Stage(name, f"{name}.odb") for name in names]
    extraction = [Stage("extract", f"{corner}.spef", corner) for corner in wires]
    timing = [Stage("sta", f"{corner}.{tech.corners[-1]}.sdf", corner) for corner in wires]
    return [Stage("synth", "netlist.json"), *databases, Stage("finish", "final.v"), *extraction, *timing]


def wire_corners(tech: OpenRoadPlatform, root: Path) -> list[str]:
    """Corners of parasitics for which the PDK in ``root`` has rules."""
    return [name for name in WIRES if any((root / path).is_file() for path in tech.rcx_rules[name])]


def pdk_root(tech: OpenRoadPlatform, environment: Mapping[str, str] = os.environ) -> Path:
    """Return the folder PDK_ROOT, every file of the process there. Raises ParameterError."""
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
    """Return the stages' programs that are not installed."""
    return [*(["yosys"] if not shutil.which("yosys") else []), *(["openroad"] if not openroad.program() else [])]


def run(folder: Path, top: str, tech: OpenRoadPlatform, root: Path, note: Callable[[str], None]) -> dict[str, float]:
    """Run every stage of the module ``top`` in ``folder``; returns the figures by name, of its logs.

    They are the lines 'TALBOT name value', and 'seconds.<stage>' and 'mib.<stage>' (peak memory) of each. A stage whose
    scripts, tools and inputs are those of an earlier run is not run again. note: called with each stage's name. Raises
    ToolError with the last lines of a stage that failed.
    """
    text = (root / tech.liberty[tech.corners[0]]).read_text(
        encoding="utf-8"
    )  # cells are chosen by their slowest delays
    (folder / "synthesis.lib").write_text(without(text, tech.dont_use), encoding="utf-8")
    wires = wire_corners(tech, root)
    pdk = [*tech.liberty.values(), tech.tech_lef, tech.cell_lef]
    pdk += [path for name in wires for path in tech.rcx_rules[name] if (root / path).is_file()]
    written = f"{top}.sv", f"{top}.sdc", "design.tcl", "common.tcl"
    key = digest(*(folder / name for name in written), *(root / path for path in pdk))
    found: dict[str, float] = {}
    for stage in stages(tech, wires):
        note(stage.label)
        key = digest(
            key, stage, folder / f"{stage.name}.tcl", version("yosys" if stage.name == "synth" else "openroad")
        )
        found |= _kept(folder, stage, key) or _run(folder, stage, key, top, tech, root)
    return found


def _kept(folder: Path, stage: Stage, key: str) -> dict[str, float] | None:
    """The figures of ``stage`` as it ran before with the same key; None where it did not, or its result changed."""
    result = folder / stage.gives
    for before in kept(folder / f"{stage.label}.json"):
        if before["key"] == key and result.is_file() and before["result"] == digest(result):
            return before["figures"]
    return None


def _run(folder: Path, stage: Stage, key: str, top: str, tech: OpenRoadPlatform, root: Path) -> dict[str, float]:
    """Run ``stage``; its figures, which are kept under ``key``. Raises ToolError."""
    name, begin = stage.label, time.perf_counter()
    (folder / stage.gives).unlink(missing_ok=True)
    variables = ENVIRONMENT | {"PDK_ROOT": str(root), "CORNER": stage.corner}
    done, peak = alone(finish, stage.command(), variables, folder, None, folder / f"{name}.log")
    written = (folder / stage.gives).is_file()
    if done.returncode or not written:
        tail = "\n".join(done.stdout.strip().splitlines()[-10:])
        state = f"status {done.returncode}, {stage.gives} {'written' if written else 'not written'}"
        raise ToolError(f"{'yosys' if stage.name == 'synth' else 'openroad'} {stage.name}: {state}:\n{tail}")
    if stage.name == "synth":
        write_synthesized(folder, top, tech)
    measured = figures(done.stdout) | {f"seconds.{name}": round(time.perf_counter() - begin, 1), f"mib.{name}": peak}
    record = {"key": key, "result": digest(folder / stage.gives), "figures": measured}
    with staged(folder) as part:
        (part / f"{name}.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return measured
