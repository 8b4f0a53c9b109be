"""Replay of a trace into its component's Verilog: Verilator's counts, state registers, functional cover points."""

import re
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from talbot.base.tools import ToolError
from talbot.rtl.replay import load
from talbot.verif.coverage.points import POINTS
from talbot.verif.coverage.ports import Recorded
from talbot.verif.verilated.program import Registers, compile_program

KINDS = {"v_line": "line", "v_branch": "branch", "v_toggle": "toggle", "v_expr": "expression"}


@dataclass(frozen=True)
class Point:
    """A point that Verilator counts.

    kind: 'line', 'branch', 'expression' or 'toggle'. module: in the Verilog. what: 'if', 'else', 'block', ...,
    '(a==1 && b==0) => 0' or 'signal[3]:0->1'. code: the text of its line. nth: index among identical points of the
    module. line: in the Verilog. source: file, and line if known, of the Python that it comes from.
    """

    kind: str
    module: str
    what: str
    code: str
    nth: int
    line: int
    source: str

    @property
    def key(self) -> tuple[str, str, str, str, int]:
        """The identity of the point in the Verilog of every parameter set."""
        return self.kind, self.module, self.what, self.code if self.kind != "toggle" else "", self.nth


class Place(NamedTuple):
    """A place at which Verilator counts: kind and what of a Point, line and column of the Verilog."""

    kind: str
    module: str
    line: int
    column: int
    what: str


class Source(NamedTuple):
    """The origin of a line of Verilog: its module, or '', and the file and line of the Python, or ''."""

    module: str
    python: str


@dataclass(frozen=True)
class Count:
    """Number of hits of a point."""

    point: Point
    times: int


@dataclass(frozen=True)
class Transition:
    """A step of state machine number ``machine`` of a plan; reset: 1 in reset. before, after: values of its state."""

    machine: int
    reset: int
    before: int
    after: int
    times: int


@dataclass(frozen=True)
class Measurement:
    """The points that a trace reaches. functional: cycles in which each functional cover point is true."""

    cycles: int
    counts: tuple[Count, ...]
    transitions: tuple[Transition, ...]
    functional: dict[str, int]


def sources_of(verilog: str) -> list[Source]:
    """Return the Source of each line of ``verilog``, line 1 at index 1."""
    module, file, source, out = "", "", "", [Source("", "")]
    for text in verilog.splitlines():
        if match := re.match(r"\s*// At (\S+)", text):
            source = match[1]
            file = source if ":" not in source else file
        if match := re.match(r"module (\w+)", text):
            module = match[1]
        elif text.startswith("endmodule"):
            module = ""
        out.append(Source(module, source if ":" in source and source.startswith(file) else file))
        if re.match(r"  end$|  assign ", text):
            source = file
    return out


def read_points(path: Path, verilog: str) -> dict[Point, int]:
    """Return the counts of Verilator's file ``path`` for ``verilog``; toggles are those after the first cycle."""
    lines, where = verilog.splitlines(), sources_of(verilog)
    rows, first = read_counts(path), read_counts(Path(f"{path}.first"))
    points, identical = {}, Counter()
    for place, count in sorted(rows.items()):
        code = " ".join(lines[place.line - 1].split())
        same = place.kind, place.module, place.what, code
        point = Point(*same, identical[same], place.line, where[place.line].python)
        identical[same] += 1
        points[point] = count - (first[place] if place.kind == "toggle" else 0)
    return points


def read_counts(path: Path) -> Counter[Place]:
    """Return the counts of a file that Verilator wrote."""
    rows: Counter[Place] = Counter()
    for row in path.read_text(encoding="utf-8").splitlines():
        if not row.startswith("C "):
            continue
        text, _, count = row[3:].rpartition("' ")
        fields = dict(part.split("\x02", 1) for part in text.split("\x01") if part)
        kind, _, module = fields["page"].partition("/")
        if kind in KINDS:
            what = fields["o"].replace("___05F", "__")  # Verilator's way to write a name's two underscores
            rows[Place(KINDS[kind], module, int(fields["l"]), int(fields["n"]), what)] += int(count)
    return rows


def measure(path: Path | str, folder: str, registers: tuple[Registers, ...], points: list[str]) -> Measurement:
    """Replay the trace ``path``.

    folder: of the block below rtl/, whose own modules count. registers: of each state machine. points: names of the
    functional cover points of the folder to evaluate. Raises ToolError where the Verilog differs from the trace.
    """
    path, prefix = Path(path), f"rtl/{folder}/"
    trace = load(path)
    verilog = trace.verilog()
    program = compile_program(verilog, trace.cls, trace.ports, registers, coverage=True)
    with tempfile.TemporaryDirectory(prefix="talbot-") as temporary:
        counts, states = Path(temporary) / "counts", Path(temporary) / "states"
        differs = program.run(path.with_suffix(".trace"), "--points", counts, "--states", states)[0]
        if differs >= 0:
            raise ToolError(f"{trace.name}: the Verilog differs from {trace.test_at(differs)} in cycle {differs}")
        reached = read_points(counts, verilog)
        steps = tuple(Transition(*map(int, line.split())) for line in states.read_text(encoding="utf-8").splitlines())
    ports = Recorded(trace)
    return Measurement(
        trace.cycles,
        tuple(Count(point, times) for point, times in reached.items() if point.source.startswith(prefix)),
        steps,
        {name: int(POINTS[folder][name](ports).sum()) for name in points},
    )
