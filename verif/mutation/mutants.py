"""Mutants of a block's Verilog by Yosys: a seeded sample spread over its modules.

All mutants are in one design with an input ``mutant`` that selects one (0: none).
"""

import json
import math
import re
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from talbot.verif.coverage.measure import sources_of
from talbot.verif.verilated.program import tool

PREPARE = "read_verilog -sv dut.v; hierarchy -check -top {top}; proc; opt_expr; opt_muxtree; opt_clean"
BITS = 16  # of the input `mutant`
LEAST = 2  # mutants of a module that has as many


@dataclass(frozen=True)
class Mutant:
    """A mutant.

    number: 1 and up. options: of Yosys's command `mutate`. module, line: in the Verilog, 0 for no line. source: file
    and, if known, line of the Python. code: text of the Verilog's line.
    """

    number: int
    options: str
    module: str
    line: int
    source: str
    code: str

    def __str__(self) -> str:
        command = " ".join(word for word in re.sub(r"-(src|wire|wirebit|module) \S+", "", self.options).split())
        return f"{self.source} ({self.module}.v line {self.line}): {command} of {self.code!r}"


def yosys(script: str, files: Mapping[str, str]) -> dict[str, bytes]:
    """Run a Yosys script in a temporary folder with ``files`` (name -> text); returns the files after it."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        for name, text in files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        (Path(folder) / "script.ys").write_text(script.replace("; ", "\n") + "\n", encoding="utf-8")
        tool(["yosys", "-q", "script.ys"], cwd=folder)
        return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def own_modules(verilog: str, folder: str) -> list[str]:
    """Return the modules of ``verilog`` that come from rtl/<folder>, ascending."""
    return sorted({module for module, source in sources_of(verilog) if module and source.startswith(f"rtl/{folder}/")})


def cells_of(verilog: str, top: str) -> dict[str, int]:
    """Return the number of cells of every module after Yosys's `proc`."""
    out = yosys(f"{PREPARE.format(top=top)}; tee -q -o stat.json stat -json", {"dut.v": verilog})["stat.json"]
    return {name.removeprefix("\\"): module["num_cells"] for name, module in json.loads(out)["modules"].items()}


def shares(cells: Mapping[str, int], number: int) -> dict[str, int]:
    """Return how many of ``number`` mutants each module gets: by the root of its cells, at least LEAST."""
    weight = {module: math.sqrt(count) for module, count in cells.items() if count}
    whole = sum(weight.values())
    return {module: max(LEAST, round(number * w / whole)) for module, w in weight.items()}


def generate(verilog: str, top: str, folder: str, number: int, seed: int) -> list[Mutant]:
    """Return about ``number`` different mutants of the modules of ``top`` that come from rtl/<folder>."""
    cells = cells_of(verilog, top)
    parts = shares({module: cells.get(module, 0) for module in own_modules(verilog, folder)}, number)
    lists = [f"mutate -list {count} -seed {seed} -module {module} -o {module}.list" for module, count in parts.items()]
    files = yosys("; ".join([PREPARE.format(top=top), *lists]), {"dut.v": verilog})
    where, lines = sources_of(verilog), ["", *verilog.splitlines()]
    mutants: list[Mutant] = []
    listed = (line for module in parts for line in files[f"{module}.list"].decode().splitlines())
    # In the proof of equivalence every register is clocked alike: of a changed clock it would say nothing. A memory is
    # read without a clock, and Yosys refuses an enable there.
    unused = re.compile(r"-port CLK |-cell \$memrd\S* -port EN ")
    chosen = dict.fromkeys(line for line in listed if not unused.search(line))
    for options in chosen:
        (module,) = re.findall(r"-module (\S+)", options)
        line = _line(options)
        mutants.append(
            Mutant(
                len(mutants) + 1,
                options.removeprefix("mutate "),
                module,
                line,
                where[line].python,
                " ".join(lines[line].split()),
            )
        )
    return mutants


def _line(options: str) -> int:
    """Return the line of the shortest range of the Verilog that a mutation names, 0 for none."""
    ranges = [tuple(map(int, r)) for r in re.findall(r"-src dut\.v:(\d+)\.\d+-(\d+)\.\d+", options)]
    return min(ranges, key=lambda r: r[1] - r[0])[0] if ranges else 0


def with_mutants(verilog: str, top: str, mutants: Iterable[Mutant]) -> str:
    """Return the Verilog of ``top`` with all ``mutants`` and an input `mutant` that selects one."""
    commands = [f"mutate -ctrl mutant {BITS} {mutant.number} {mutant.options}" for mutant in mutants]
    script = "; ".join([PREPARE.format(top=top), *commands, "write_verilog -noattr mutants.v"])
    return yosys(script, {"dut.v": verilog})["mutants.v"].decode()
