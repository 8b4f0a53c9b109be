"""A stage of place and route: a script of flow/layout/tcl in OpenROAD, from the database of the stage before."""

import os
import re
import signal
import subprocess
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import joblib

from talbot.base import openroad
from talbot.base.steps import Files, Step, StepError
from talbot.base.tools import started
from talbot.flow.layout.variables import Floor, variables
from talbot.models.parameters import check_choice
from talbot.platforms.layout import layout_platform
from talbot.platforms.place_and_route import place_and_route

SCRIPTS = Path(__file__).parents[1] / "tcl"
LEFS = {"tech_lef": "library.tech_lef", "cell_lef": "library.cell_lef"}
# Stages in their order, with the figures that their scripts print
STAGES: dict[str, dict[str, str]] = {
    "floorplan": {},
    "power": {},
    "place": {"placement_density": ""},
    "cts": {},
    "repair": {},
    "loads": {"estimated_beyond": "pins", "estimated_setup_ns": "ns", "estimated_hold_ns": "ns"},
    "route": {},
    "mend": {"router_drc_violations": "", "router_antennas": ""},
    "thresholds": {"raised_thresholds": "", "routed_beyond": "pins", "routed_setup_ns": "ns"},
    "finish": {"open_nets": ""},
}
# What stages read other than the database of the stage before
INPUTS: dict[str, dict[str, str]] = {
    "floorplan": {"netlist": "synthesis.verilog"} | LEFS,
    "thresholds": {"netlist": "routed_stream_out.verilog", "wires": "routed_extraction.max"} | LEFS,
    "finish": {"database": "mend.database", "raised": "thresholds.raised"},
}
# What stages write other than a database
OUTPUTS: dict[str, dict[str, str]] = {
    "mend": {"database": "mend.odb", "def": "mend.def"},
    "thresholds": {"raised": "raised.txt"},
    "finish": {"def": "final.def"},
}
# Threads that wait give their core away: next to other jobs, placement of the divider took 15 times its CPU time
ENVIRONMENT = {"OMP_WAIT_POLICY": "passive"}
LOOK_S = 2.0  # how often a stage's log is looked at
SILENT_S = 1200.0  # without a line in its log a stage hangs
# A message that the design is the cause of: of the tool, or of `stop` in flow/layout/tcl/common.tcl
ERROR = re.compile(r"(?m)^\[ERROR .*|(?<=^TALBOT stopped: ).*")
FROM_OUTSIDE = signal.SIGKILL, signal.SIGTERM
PATIENCE = 10  # iterations of detailed routing without fewer violations, after which it does not converge
CROWDED = 2.5  # violations a net after the first iteration: 1.4 to 1.8 ended, 3.2 and 7.6 did not
HOPELESS = 8, 0.3  # after so many iterations, more than this share of the first violations
ROUTING = "[INFO DRT-0187]"  # the line with which detailed routing begins
# An iteration that takes so many times as long as the longest of the first ones, and as LEAST_S, is about a few
# violations that no route of their tiles mends. It gets EACH_S more for each of them: those that ended took 15 to 70 s
STUBBORN, SLOW, LEAST_S, EACH_S = 5, 3.0, 60.0, 45.0


@dataclass(frozen=True)
class StageParameters:
    """Parameters of `Stage`.

    top: module. corners: of the cells. stage: of STAGES. floor: of `floorplan`. frame: of the process, '' for none.
    closed: edges without pins. clock: the port whose net alone gets a tree, of `cts`; '' for all nets of clocks.
    """

    pdk: str = "sky130"
    top: str = ""
    corners: tuple[str, ...] = ()
    stage: str = "floorplan"
    floor: Floor = Floor()
    frame: str = ""
    closed: tuple[str, ...] = ()
    clock: str = ""

    def __post_init__(self) -> None:
        check_choice("stage", self.stage, STAGES)


class Stopped(StepError):
    """A stage ended without a result. again: whether it may end otherwise with the setting `careful`."""

    def __init__(self, why: str, again: bool = False) -> None:
        super().__init__(why)
        self.again = again


def scripts() -> dict[str, Path]:
    """The stages' scripts as files that a Runner gives to `Stage`."""
    return {f"tcl.{name}": SCRIPTS / f"{name}.tcl" for name in ("common", *STAGES)}


class Stage(Step[StageParameters]):
    """One script, in one process.

    One that crashes or hangs is run again with the setting `careful` (flow/layout/tcl/common.tcl), once; `again` says
    why. stopped: why there is no result, the last line of an error; None where there is one.
    """

    tools = ("openroad",)

    def __init__(self, parameters: StageParameters) -> None:
        super().__init__(parameters)
        self.name = parameters.stage
        names = list(STAGES)
        before = {"database": f"{names[names.index(self.name) - 1]}.database"}
        self.inputs = {"sdc": "place_and_route_sdc", "common": "tcl.common", "script": f"tcl.{self.name}"}
        self.inputs |= INPUTS.get(self.name, before) | {corner: f"timing.{corner}" for corner in parameters.corners}
        self.outputs = OUTPUTS.get(self.name, {"database": f"{self.name}.odb"})
        self.metrics = {"stopped": "", "again": "", **STAGES[self.name]}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        folder = next(iter(outputs.values())).parent
        found, again = dict.fromkeys(self.metrics), None
        with tempfile.TemporaryDirectory(dir=folder) as name:
            work = Path(name)
            self.prepare(work, inputs)
            try:
                try:
                    text = self.script(work, folder / f"{self.name}.log")
                except Stopped as stop:
                    if not stop.again:
                        raise
                    again = str(stop)
                    text = self.script(work, folder / f"{self.name}.again.log", careful=True)
            except Stopped as stop:
                for path in outputs.values():
                    path.write_text("", encoding="utf-8")
                return found | {"stopped": str(stop), "again": again}
            for path in outputs.values():
                (work / path.name).replace(path)
        measured = {name: value for name, value in figures(text).items() if name in self.metrics}
        return found | measured | {"again": again}

    def prepare(self, work: Path, inputs: Files) -> None:
        """Put the scripts and the inputs into the folder ``work``, under the names that the scripts have for them."""
        (work / "design.tcl").write_text(design_tcl(self.parameters), encoding="utf-8")
        files = called(self.parameters, self.name, self.inputs.get("database", "").partition(".")[0])
        for name, path in inputs.items():
            (work / files[name]).symlink_to(path.resolve())

    def script(self, work: Path, log: Path, careful: bool = False) -> str:
        """Run the script in the folder ``work``; its output. Raises Stopped."""
        command = openroad.command(f"{self.name}.tcl", joblib.cpu_count())
        variables = ENVIRONMENT | {"CAREFUL": str(int(careful))}
        with log.open("wb") as file, started(command, file, env=variables, cwd=work) as child:
            watch(child, log)
        text = log.read_text(encoding="utf-8", errors="replace")
        if -child.returncode in FROM_OUTSIDE:
            raise StepError(f"{self.name}: openroad was ended by signal {-child.returncode}: no memory left, or a user")
        if child.returncode < 0:
            raise Stopped(f"openroad ended by signal {-child.returncode}", again=not careful)
        if child.returncode:
            if found := ERROR.findall(text):
                raise Stopped(found[-1].strip())
            raise StepError(f"{self.name}: openroad: {(text.strip().splitlines() or ['no message'])[-1]}")
        if lacking := [name for name in self.outputs.values() if not (work / name).is_file()]:
            raise Stopped(f"openroad did not write {lacking[0]}", again=not careful)
        return text


def figures(text: str) -> dict[str, float]:
    """Return the figures that scripts printed as lines 'TALBOT name value', by name: counts as integers."""
    pairs = re.findall(r"(?m)^TALBOT (\S+) (\S+)$", text)
    return {name: int(value) if value.isdecimal() else float(value) for name, value in pairs}


def design_tcl(p: StageParameters) -> str:
    """Text of design.tcl."""
    files: dict[str, object] = {"tech_lef": "tech.lef", "cell_lef": "cells.lef", "corners": p.corners}
    files |= {"liberty": {corner: f"{corner}.lib" for corner in p.corners}, "closed": p.closed, "clock": p.clock}
    frame = layout_platform(p.pdk).frame(p.frame) if p.frame else None
    return variables(p.top, place_and_route(p.pdk), p.floor, files, frame)


def called(p: StageParameters, stage: str, before: str = "") -> dict[str, str]:
    """Names that the scripts have for the inputs of ``stage``. before: the stage whose database it opens."""
    names = {"netlist": "netlist.v", "tech_lef": "tech.lef", "cell_lef": "cells.lef", "sdc": f"{p.top}.sdc"}
    names |= {corner: f"{corner}.lib" for corner in p.corners} | {"wires": "wires.spef", "raised": "raised.txt"}
    return names | {"common": "common.tcl", "script": f"{stage}.tcl", "database": f"{before}.odb"}


def watch(child: "subprocess.Popen[bytes]", log: Path) -> None:
    """Wait for the end of ``child``. Raises Stopped for one whose routing does not converge, or whose log ends."""
    size, begin, marks = -1, time.monotonic(), list[float]()
    while True:
        try:
            child.wait(LOOK_S)
            return
        except subprocess.TimeoutExpired:
            pass
        now, text = processor_s(child.pid), log.read_text(encoding="utf-8", errors="replace")
        iterations = text.rpartition(ROUTING)[2].count("[INFO DRT-0195]")
        marks = marks[:iterations] + [now] * (iterations - len(marks))
        seconds = [after - before for before, after in pairwise([*marks, now])]
        if diverges(counts := violations(text), seconds, net_count(text)):
            raise Stopped(f"detailed routing does not converge: {' '.join(map(str, counts))} violations")
        if len(text) != size:
            size, begin = len(text), time.monotonic()
        elif time.monotonic() - begin > SILENT_S:
            raise Stopped(f"no line in {SILENT_S:g} s", again=True)


def processor_s(pid: int) -> float:
    """Seconds that a process has had of processors; those of the clock on the wall where there is no /proc."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:
        return time.monotonic()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def violations(log: str) -> list[int]:
    """Violations after each iteration of the last detailed routing in a ``log``."""
    last = log.rpartition(ROUTING)[2]
    return [int(number) for number in re.findall(r"\[INFO DRT-0199\]\s+Number of violations = (\d+)", last)]


def net_count(log: str) -> int:
    """Nets that detailed routing counts in a ``log``; 0 where it has not begun."""
    return int((re.findall(r"(?m)^Number of nets: +(\d+)", log) or [0])[-1])


def diverges(counts: Sequence[int], seconds: Sequence[float] = (), nets: int = 0) -> bool:
    """Whether detailed routing will not end.

    counts: violations after each iteration. seconds: of processors, of each iteration; the last has not ended where
    there are more than counts, else what follows it is in its seconds. nets: of the design, 0 if unknown.
    """
    if nets and counts and counts[0] > CROWDED * nets:
        return True
    number, share = HOPELESS
    stubborn = EACH_S * counts[-1] if counts else 0.0
    if len(seconds) > max(STUBBORN, len(counts)) and seconds[-1] > SLOW * max(*seconds[:STUBBORN], LEAST_S) + stubborn:
        return True
    if len(counts) > number and counts[-1] > share * counts[0]:
        return True
    return len(counts) > PATIENCE and min(counts[-PATIENCE:]) >= min(counts[:-PATIENCE])
