"""The stages in their order: each a script in tcl/, run by Yosys or OpenROAD in the design's folder."""

import os
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from base.liberty.read import without
from base.tools import ToolError, finish
from models.parameters import ParameterError
from platforms.openroad import CORNERS

SCRIPTS = Path(__file__).parent / "tcl"
INSTALL = "https://openroad.readthedocs.io (packages, source) or a LibreLane or flow-scripts container"


@dataclass(frozen=True)
class Stage:
    """name: of its script and log. gives: file without which it failed. corner: of the timing, or ''."""

    name: str
    gives: str
    corner: str = ""

    @property
    def log(self):
        return f"{self.name}.{self.corner}.log" if self.corner else f"{self.name}.log"

    def command(self):
        return (
            ["yosys", "-q", "-c", "synth.tcl"]
            if self.name == "synth"
            else ["openroad", "-no_init", "-no_splash", "-threads", "max", "-exit", f"{self.name}.tcl"]
        )


def stages(top):
    """Every Stage for the module ``top``."""
    databases = [Stage(name, f"{name}.odb") for name in ("floorplan", "power", "place", "cts", "hold", "route")]
    return [
        Stage("synth", "netlist.v"),
        *databases,
        Stage("finish", f"{top}.spef"),
        *(Stage("sta", f"{top}.{corner}.sdf", corner) for corner in CORNERS),
    ]


def pdk_root(known, environment=os.environ):
    """The folder PDK_ROOT, every file of the process there. Raises ParameterError."""
    root = environment.get("PDK_ROOT", "")
    if not root:
        raise ParameterError(
            "PDK_ROOT = '': must be the folder of an installed PDK "
            f"(pip install ciel; ciel enable --pdk-family {known.name} <version>)"
        )
    needed = [(path,) for path in (*known.liberty.values(), known.tech_lef, known.cell_lef, known.cell_gds)]
    for paths in (*needed, known.rcx_rules):
        if not any((Path(root) / path).is_file() for path in paths):
            raise ParameterError(f"PDK_ROOT = {root}: must hold {' or '.join(paths)}")
    return Path(root)


def missing_tools():
    """Of the programs that the stages call, those not on PATH."""
    return [tool for tool in ("yosys", "openroad") if not shutil.which(tool)]


def run(folder, top, known, root, note):
    """Run every stage in ``folder``; returns dict figure -> number, of the lines 'TALBOT name value' in their logs.

    note: called with each stage's name. Raises ToolError with the last lines of a stage that failed.
    """
    text = (root / known.liberty["typical"]).read_text()
    (folder / "synthesis.lib").write_text(without(text, known.dont_use))
    found = {}
    for stage in stages(top):
        note(stage.log.removesuffix(".log"))
        (folder / stage.gives).unlink(missing_ok=True)
        done = finish(stage.command(), cwd=folder, env={"PDK_ROOT": str(root), "CORNER": stage.corner})
        (folder / stage.log).write_text(done.stdout + done.stderr)
        if done.returncode or not (folder / stage.gives).is_file():
            tail = "\n".join((done.stdout + done.stderr).strip().splitlines()[-10:])
            raise ToolError(
                f"{stage.command()[0]} {stage.name}: status {done.returncode}, {stage.gives} "
                f"{'written' if (folder / stage.gives).is_file() else 'not written'}:\n{tail}"
            )
        found |= {name: float(value) for name, value in re.findall(r"^TALBOT (\S+) (\S+)$", done.stdout, re.M)}
    return found
