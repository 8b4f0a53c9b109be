"""One trace replayed into the Verilog of its component: what Verilator counts, registers, functional cover points."""

import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

from base.tools import ToolError
from rtl.replay import load

from .points import POINTS
from .ports import Recorded
from .program import compile_program

KINDS = {"v_line": "line", "v_branch": "branch", "v_toggle": "toggle"}


@dataclass(frozen=True)
class Point:
    """One thing that Verilator counts.

    kind: 'line', 'branch' or 'toggle'. module: in the Verilog. what: 'if', 'else', 'block', ... or
    'signal[3]:0->1'. code: the text of its line. nth: of the points that are alike so far in their module. line: in
    the Verilog. source: file, and line if known, of the Python that it comes from.
    """

    kind: str
    module: str
    what: str
    code: str
    nth: int
    line: int
    source: str

    @property
    def key(self):
        """The same in the Verilog of every parameter set."""
        return self.kind, self.module, self.what, self.code if self.kind != "toggle" else "", self.nth


def sources_of(verilog):
    """By line of ``verilog`` (text), counted from 1: (its module, or '', and the Python that it comes from)."""
    module, file, source, out = "", "", "", [("", "")]
    for text in verilog.splitlines():
        if found := re.match(r"\s*// At (\S+)", text):
            source = found[1]
            file = source if ":" not in source else file
        if found := re.match(r"module (\w+)", text):
            module = found[1]
        elif text.startswith("endmodule"):
            module = ""
        out.append((module, source if ":" in source and source.startswith(file) else file))
        if re.match(r"  end$|  assign ", text):
            source = file
    return out


def read_points(path, verilog):
    """The counts of Verilator's file ``path`` for ``verilog`` (text): dict Point -> times.

    Toggles are those behind the first cycle.
    """
    lines, where = verilog.splitlines(), sources_of(verilog)
    rows, first = read_counts(path), read_counts(f"{path}.first")
    found, alike = {}, {}
    for place, count in sorted(rows.items()):
        kind, module, line, _, what = place
        code = " ".join(lines[line - 1].split())
        same = kind, module, what, code
        nth = alike[same] = alike.get(same, -1) + 1
        found[Point(kind, module, what, code, nth, line, where[line][1])] = count - (
            first[place] if kind == "toggle" else 0
        )
    return found


def read_counts(path):
    """The rows of Verilator's file: dict (kind, module, line, column, what) -> times."""
    rows = {}
    for row in Path(path).read_text().splitlines():
        if not row.startswith("C "):
            continue
        text, _, count = row[3:].rpartition("' ")
        fields = dict(part.split("\x02", 1) for part in text.split("\x01") if part)
        kind, _, module = fields["page"].partition("/")
        if kind in KINDS:
            what = fields["o"].replace("___05F", "__")  # Verilator's way to write a name's two underscores
            place = KINDS[kind], module, int(fields["l"]), int(fields["n"]), what
            rows[place] = rows.get(place, 0) + int(count)
    return rows


def measure(path, folder, registers, points):
    """Replay the trace ``path``: dict points, states, functional.

    folder: of the block, whose own modules count. registers: names of `program.header`. points: names of the
    functional cover points of the folder to evaluate.
    Raises ToolError where the Verilog does not do what the tests saw.
    """
    trace = load(path)
    verilog = trace.verilog()
    program = compile_program(verilog, trace.cls, trace.ports, registers, coverage=True)
    with tempfile.TemporaryDirectory(prefix="talbot-") as temporary:
        counts, states = Path(temporary) / "counts", Path(temporary) / "states"
        differs = program.run(Path(path).with_suffix(".trace"), "--points", counts, "--states", states)[0]
        if differs >= 0:
            raise ToolError(f"{trace.name}: the Verilog differs from {trace.test_at(differs)} in cycle {differs}")
        found = read_points(counts, verilog)
        steps = [tuple(map(int, line.split())) for line in states.read_text().splitlines()]
    own = f"rtl/{folder}/"
    ports = Recorded(trace)
    return {
        "cycles": trace.cycles,
        "points": [[*vars(p).values(), n] for p, n in found.items() if p.source.startswith(own)],
        "states": steps,
        "functional": {name: int(POINTS[folder][name](ports).sum()) for name in points},
    }
