"""The chip in Verilator with its counters of coverage, random values at power-on, and metastable synchronizers."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD
from talbot.base.tools import ToolError, run
from talbot.base.verilator import compile_program, runtime, verilate, verilator_version
from talbot.models.parameters import ASYNCHRONOUS, ArrayParameters, ChipParameters, SensorParameters, TileParameters
from talbot.rtl.contract import contract
from talbot.rtl.export import translate

MAIN = Path(__file__).parent / "main.cpp"
FLAGS = (
    *("-O3", "--x-assign", "unique", "--x-initial", "unique", "--noassert", "--no-timing", "-Wno-lint", "-Wno-fatal"),
    *("--coverage-line", "--coverage-expr", "-fno-split", "--output-split", "0"),
)
CXX_FLAGS = "-O1", "-DVM_COVERAGE=1"
STATE = "states__state"  # the register `state`, a net of the chip
PUBLIC = f'`verilator_config\npublic_flat_rd -module "AspChip" -var "{STATE}"\n'
FIRST = re.compile(r"stages <= \{ stages\[1'd0\], pin \};")
# A first flip-flop whose pin has changed takes the old or the new value, a cycle later the new one
DECLARED = "logic [1:0] stages;"
SEEN = (
    DECLARED
    + """
  logic metastable, late;
  initial metastable = $test$plusargs("metastable");"""
)
METASTABLE = """if (metastable && pin != stages[0] && !late && $urandom_range(1) == 1) begin
      late <= 1'b1;
      stages <= {stages[0], stages[0]};
    end else begin
      late <= 1'b0;
      stages <= {stages[0], pin};
    end"""

ORDER = tuple(np.random.default_rng(52).permutation(6).tolist())
CHIPS = {
    "8 x 13, 2 lanes": SensorParameters(array=ArrayParameters(8, 13), chip=ChipParameters(lanes=2)),
    "7 x 11, 4 lanes, tiles of 3 x 2": SensorParameters(
        tile=TileParameters(3, 2, TileParameters().types[:6], ORDER),
        array=ArrayParameters(7, 11),
        chip=ChipParameters(lanes=4, divider="pipelined"),
    ),
}


def metastable(verilog: str) -> str:
    """Return the chip's Verilog with synchronizers that, with +metastable, delay a change by no cycle or one.

    Raises ToolError where the asynchronous pins do not have one synchronizer each (rtl/crossings.py checks the rest).
    """
    text, changed = FIRST.subn(METASTABLE, verilog)
    instances = len(re.findall(r"^ *Synchronizer (?:\w+)$", verilog, re.MULTILINE))
    if changed != 1 or instances != len(ASYNCHRONOUS):
        raise ToolError(f"synchronizers = {instances}, of {changed} modules: must be {len(ASYNCHRONOUS)}, of one")
    return text.replace(DECLARED, SEEN, 1)


@cache
def chip_verilog(name: str) -> str:
    """Return the Verilog of a chip of CHIPS."""
    return translate("AspChip", CHIPS[name])


def program(name: str, verilog: str = "") -> Path:
    """Return the executable of a chip of CHIPS, compiled once. verilog: instead of the chip's. Raises ToolError."""
    sensor = CHIPS[name]
    checks = contract(sensor.chip.lanes, sensor.chip.has_phase_path)
    text = f"{metastable(verilog or chip_verilog(name))}\n{checks}"
    state = f"AspChip__DOT__{STATE.replace('__', '___05F')}"
    sizes = [f"-DLANES={sensor.chip.lanes}", f"-DTILE_COLS={sensor.tile.cols}", f"-DSTATE={state}"]

    def make(folder: Path) -> None:
        source, public, unit = folder / "chip.sv", folder / "public.vlt", folder / "unit.o"
        source.write_text(text, encoding="utf-8")
        public.write_text(PUBLIC, encoding="utf-8")
        model = verilate(folder / "obj", "AspChip", [public, source], FLAGS)
        compile_program(unit, [*model, MAIN], [*CXX_FLAGS, *sizes, "-c"])
        compile_program(folder / "program", [], [unit, *runtime(), *runtime(["verilated_cov"])])

    key = digest(text, PUBLIC, FLAGS, CXX_FLAGS, sizes, MAIN, verilator_version())
    return cached(BUILD / "fuzz" / key, make) / "program"


@dataclass(frozen=True)
class Byte:
    """What a byte of a transfer meets: (busy, link_val, bytes taken) at moments after its eighth bit.

    effect: when it may take effect, without and with a late synchronizer. aborted: bytes taken until it has aborted.
    fetch: when the byte that answers it may be fetched.
    """

    effect: list[tuple[int, int, int]]
    aborted: int
    fetch: list[tuple[int, int, int]]


@dataclass(frozen=True)
class Observed:
    """An operation's end: cycle, cycles of the link's stalls, `busy`, bytes taken; of a transfer, bits of miso."""

    cycle: int
    stalls: int
    busy: bool
    taken: int
    miso: str
    bytes: list[Byte]


@dataclass(frozen=True)
class Run:
    """A session's result. fresh: points that no session before reached. link: bytes taken, + 256 with frame_sync."""

    fresh: int
    cycles: int
    operations: list[Observed]
    link: list[int]


def run_sessions(path: Path, lines: Sequence[str], folder: Path, late: bool, words: Sequence[str] = ()) -> list[Run]:
    """Run sessions in the executable ``path``.

    folder: of the points reached. late: synchronizers delay at random. words: plusargs. Raises ToolError, also where a
    line of the interface contract is broken.
    """
    sessions = folder / "sessions.txt"
    sessions.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    options = [*(["+metastable"] if late else []), *words]
    return [parse(line, late) for line in run([path, sessions, folder / "seen.bin", *options]).splitlines()]


def parse(line: str, late: bool) -> Run:
    """Return the Run of a line of the program."""
    body, _, taken = line.partition(" s ")
    head, *operations = body.split(" o ")
    fresh, cycles = map(int, head.split())
    taken = taken.strip()
    return Run(
        fresh,
        cycles,
        [_observed(text, late) for text in operations],
        [int(taken[i : i + 3], 16) for i in range(0, len(taken), 3)],
    )


def _observed(text: str, late: bool) -> Observed:
    end, *each = text.split(" b")
    cycle, stalls, busy, taken, miso = end.split()
    count = 1 + late
    met = []
    for one in each:
        values = list(map(int, one.split()))
        at = [(values[i], values[i + 1], values[i + 2]) for i in range(0, len(values), 3)]
        met.append(Byte(at[:count], at[2 + late][2], at[4 : 4 + count]))
    return Observed(int(cycle), int(stalls), busy == "1", int(taken), "" if miso == "-" else miso, met)
