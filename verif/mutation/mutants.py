"""Mutants of a block's Verilog by Yosys: a seeded sample spread over its modules, all in one design with an input
``mutant`` that picks one (0: none)."""

import math
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

from verif.coverage.measure import sources_of
from verif.coverage.program import tool

PREPARE = "read_verilog -sv dut.v; hierarchy -check -top {top}; proc; opt_expr; opt_muxtree; opt_clean"
BITS = 16  # of the input `mutant`
LEAST = 4  # mutants of a module, where it has as many


@dataclass(frozen=True)
class Mutant:
    """number: 1 and up. options: of Yosys's command `mutate`. module: in the Verilog. line: there, or 0.
    source: file and, if known, line of the Python. code: text of the Verilog's line.
    """

    number: int
    options: str
    module: str
    line: int
    source: str
    code: str

    def __str__(self):
        what = " ".join(word for word in re.sub(r"-(src|wire|wirebit|module) \S+", "", self.options).split())
        return f"{self.source} ({self.module}.v line {self.line}): {what} of {self.code!r}"


def yosys(script, files):
    """Run a Yosys script in a folder of its own with ``files`` (dict name -> text): dict of the files behind it."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        for name, text in files.items():
            (Path(folder) / name).write_text(text)
        (Path(folder) / "script.ys").write_text(script.replace("; ", "\n") + "\n")
        tool(["yosys", "-q", "script.ys"], cwd=folder)
        return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def own_modules(verilog, folder):
    """Modules of ``verilog`` (text) that come from rtl/<folder>, ascending."""
    return sorted({module for module, source in sources_of(verilog) if module and source.startswith(f"rtl/{folder}/")})


def cells_of(verilog, top):
    """Cells of every module behind Yosys's `proc`: dict."""
    out = yosys(f"{PREPARE.format(top=top)}; tee -q -o stat.txt stat", {"dut.v": verilog})["stat.txt"].decode()
    return {name: int(count) for name, count in re.findall(r"=== (\w+) ===.*?Number of cells:\s+(\d+)", out, re.DOTALL)}


def shares(cells, number):
    """How many of ``number`` mutants each module gets: by the root of its cells, at least LEAST. cells: dict."""
    weight = {module: math.sqrt(count) for module, count in cells.items() if count}
    whole = sum(weight.values())
    return {module: max(LEAST, round(number * w / whole)) for module, w in weight.items()}


def generate(verilog, top, folder, number, seed):
    """About ``number`` different mutants of module ``top``'s own modules: list of Mutant."""
    cells = cells_of(verilog, top)
    parts = shares({module: cells.get(module, 0) for module in own_modules(verilog, folder)}, number)
    lists = [f"mutate -list {count} -seed {seed} -module {module} -o {module}.list" for module, count in parts.items()]
    files = yosys("; ".join([PREPARE.format(top=top), *lists]), {"dut.v": verilog})
    where, lines, found = sources_of(verilog), [""] + verilog.splitlines(), []
    chosen = dict.fromkeys(line for module in parts for line in files[f"{module}.list"].decode().splitlines())
    for options in chosen:
        module = re.search(r"-module (\S+)", options)[1]
        line = _line(options)
        found.append(
            Mutant(
                len(found) + 1,
                options.removeprefix("mutate "),
                module,
                line,
                where[line][1],
                " ".join(lines[line].split()),
            )
        )
    return found


def _line(options):
    """The line of the shortest range of the Verilog that a mutation names, 0 for none."""
    ranges = [tuple(map(int, r)) for r in re.findall(r"-src dut\.v:(\d+)\.\d+-(\d+)\.\d+", options)]
    return min(ranges, key=lambda r: r[1] - r[0])[0] if ranges else 0


def with_mutants(verilog, top, mutants):
    """The Verilog of ``top`` with all ``mutants`` in it, and an input `mutant` that picks one: text."""
    commands = [f"mutate -ctrl mutant {BITS} {mutant.number} {mutant.options}" for mutant in mutants]
    script = "; ".join([PREPARE.format(top=top), *commands, "write_verilog -noattr mutants.v"])
    return yosys(script, {"dut.v": verilog})["mutants.v"].decode()
