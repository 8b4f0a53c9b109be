"""Programs that replay traces: Verilog compiled by Verilator with the ports of a trace, kept by content."""

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD
from talbot.base.sources import code
from talbot.base.tools import run
from talbot.base.verilator import CXX, compile_runtime, runtime, verilator_folder, verilator_program
from talbot.rtl.harness.ports import Port, places, split, total_width, validity

CACHE = BUILD / "replay"
MAIN = Path(__file__).parent / "main.cpp"
VALUES = ("--x-assign", "fast", "--x-initial", "unique")  # of X
VERILATE = ("--cc", "--prefix", "VDut", *VALUES, "--noassert", "--no-timing", "-Wno-lint", "-Wno-fatal")
COVERAGE = ("--coverage-line", "--coverage-expr", "--coverage-toggle", "--coverage-max-width", "4096", "--flatten")
COUNTERS = "verilated_cov"
SECONDS = 900  # limit of a tool

# Of a state machine: (name below the top, as in 'control.state'; bits), the highest bits first
Registers = tuple[tuple[str, int], ...]


def tool(command: Sequence[str | Path], seconds: float = SECONDS, cwd: Path | str | None = None) -> str:
    """Run a command with VERILATOR_ROOT set; returns its output. Raises ToolError, ToolTimeout."""
    return run(command, {"VERILATOR_ROOT": str(verilator_folder())}, cwd, seconds)


def _cxx_name(verilog: str) -> str:
    """Return Verilator's name of a Verilog identifier."""
    return verilog.replace("__", "___05F")


def _assign(port: Port, low: int) -> str:
    name = _cxx_name(port.name)
    if port.width > 64:
        return f"set_wide(top.{name}, from, {low}, {port.width});"
    return f"top.{name} = bits(from, {low}, {port.width});"


def _same(port: Port, low: int) -> str:
    name = _cxx_name(port.name)
    if port.width > 64:
        return f"same_wide(top.{name}, want, {low}, {port.width})"
    return f"top.{name} == bits(want, {low}, {port.width})"


def _put(port: Port, low: int) -> str:
    return f"put{'_wide' if port.width > 64 else ''}(to, top.{_cxx_name(port.name)}, {low}, {port.width});"


def _joined(top: str, machine: Registers) -> str:
    """Join the registers of one state machine as one number: a C++ expression."""
    value = "std::uint64_t{0}"
    for name, width in machine:
        value = f"({value} << {width} | top.rootp->{_cxx_name(top)}__DOT__{_cxx_name(name).replace('.', '__DOT__')})"
    return value


def header(top: str, ports: Sequence[Port], registers: Sequence[Registers] = (), mutant: bool = False) -> str:
    """Return ports.h (C++) for ``top``. registers: by machine. mutant: the top has an input `mutant`."""
    inputs, outputs = split(ports)
    where, valid = places(outputs), validity(ports)
    checks = []
    for port, low in where.items():
        same = _same(port, low)
        if port in valid:  # a message counts while it is valid
            same = f"!bits(want, {where[valid[port]]}, 1) || {same}"
        checks.append(f"  if (!({same})) return false;")
    states = [f"    case {i}: return {_joined(top, machine)};" for i, machine in enumerate(registers)]
    return "\n".join(
        [
            f"constexpr int IN_BITS = {total_width(inputs)}, OUT_BITS = {total_width(outputs)};",
            f"constexpr int STATES = {len(states)};",
            "static void drive(VDut& top, const Words& from) {",
            *(f"  {_assign(port, low)}" for port, low in places(inputs).items()),
            "}",
            "static bool fits(const VDut& top, const Words& want) {",
            *checks,
            "  return true;",
            "}",
            "static void show(const VDut& top, std::string& to) {",
            *(f"  {_put(port, low)}" for port, low in where.items()),
            "}",
            f"static void mutate(VDut& top, std::uint64_t number) {{ {'top.mutant = number;' if mutant else ''} }}",
            "static std::uint64_t state(const VDut& top, int i) {",
            "  switch (i) {",
            *states,
            "    default: return 0;",
            "  }",
            "}",
            "",
        ]
    )


@dataclass(frozen=True)
class Program:
    """A compiled module. folder: of the executable `replay` and of `dut.v`, its Verilog."""

    folder: Path

    def run(self, trace: Path, *options: str | Path) -> dict[int, int]:
        """Replay the file ``trace``; returns run number -> first cycle that differs, -1 for none. Raises ToolError."""
        out = tool([self.folder / "replay", trace, *options])
        return {int(number): int(cycle) for number, cycle in (line.split() for line in out.splitlines())}


def compile_program(
    verilog: str,
    top: str,
    ports: Sequence[Port],
    registers: Sequence[Registers] = (),
    coverage: bool = False,
    mutant: bool = False,
) -> Program:
    """Return the Program of module ``top`` of ``verilog``, compiled once for the same content. Raises ToolError.

    registers, mutant: see `header`. coverage: the program counts points (Verilator's --coverage).
    """
    verilator = verilator_program()
    flags = (*VERILATE, *(COVERAGE if coverage else ("-O3",)))
    lines = header(top, ports, registers, mutant)
    version = tool([verilator, "--version"])

    def make(folder: Path) -> None:
        counters, objects = _counters(version), runtime()
        source, public, model = folder / "dut.v", folder / "public.vlt", folder / "model"
        source.write_text(verilog, encoding="utf-8")
        (folder / "ports.h").write_text(lines, encoding="utf-8")
        names = sorted({name.split(".")[-1] for machine in registers for name, _ in machine})
        public.write_text(
            "`verilator_config\n" + "".join(f'public_flat_rd -module "*" -var "{n}"\n' for n in names), encoding="utf-8"
        )
        tool([verilator, *flags, "--top-module", top, "--Mdir", "model", "public.vlt", "dut.v"], cwd=folder)
        unit = folder / "unit.cpp"
        unit.write_text("".join(f'#include "{p}"\n' for p in [*sorted(model.glob("*.cpp")), MAIN]), encoding="utf-8")
        include = verilator_folder() / "include"
        includes = [
            option for path in (counters, model, folder, include, include / "vltstd") for option in ("-I", path)
        ]
        options = ["-O0" if coverage else "-O1", f"-DVM_COVERAGE={int(coverage)}", *includes]
        tool([*CXX, *options, unit, counters / f"{COUNTERS}.o", *objects, "-pthread", "-o", folder / "replay"])
        shutil.rmtree(model)
        unit.unlink()

    content = digest(code(__name__), version, flags, lines, top, verilog)
    return Program(cached(CACHE / f"{top}-{content}", make))


def _counters(version: str) -> Path:
    """Return the folder of a corrected verilated_cov.h and of the object file of Verilator's counters with it."""
    include = verilator_folder() / "include"

    def make(folder: Path) -> None:
        # Verilator 5.48 also counts toggles of lower words for the higher ones in vectors of more than 64 bits
        text = (include / f"{COUNTERS}.h").read_text(encoding="utf-8")
        (folder / f"{COUNTERS}.h").write_text(
            text.replace("j < width - i * VL_EDATASIZE;", "j < VL_EDATASIZE && j < width - i * VL_EDATASIZE;"),
            encoding="utf-8",
        )
        compile_runtime(folder, ["-O1", "-I", folder], [COUNTERS])

    return cached(CACHE / f"counters-{digest(code(__name__), version)}", make)
