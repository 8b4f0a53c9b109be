"""Verilog in Verilator, within this process: a library compiled once, and a module driven by packed inputs.

A bench in Verilog packs the ports like that of Icarus, so the C++ side has two vectors and the clock.
"""

import ctypes
import tempfile
import weakref
from collections.abc import Sequence
from pathlib import Path

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD
from talbot.base.verilator import (
    CXX,
    FAST,
    accepted,
    compile_program,
    precompiled,
    runtime,
    verilate,
    verilator_version,
)
from talbot.rtl.harness.icarus import instance
from talbot.rtl.harness.ports import Port, split, total_width

FOLDER, LIBRARY = BUILD / "verilated", "library.so"
# Warnings are errors, but those that PyMTL's Verilog gives everywhere
OPTIONS = *(word for word in FAST if word != "-Wno-lint"), "-Wno-UNOPTFLAT", "-Wno-UNSIGNED", "-Wno-WIDTH"
COMPILED = "-O0", "-fPIC"  # compiling takes longer than what the tests simulate

BENCH = """module VerilatedBench(input clk, input [{high_in}:0] in, output [{high_got}:0] got);
{instance}endmodule
"""
WRAPPER = """#include <cstring>
struct Model { VerilatedContext context; VVerilatedBench bench{&context}; };
extern "C" {
void* start() { return new Model; }
void end(void* model) { delete static_cast<Model*>(model); }
void step(void* model, int edge, const char* in, char* got) {
  auto& bench = static_cast<Model*>(model)->bench;
  if (edge) {
    bench.clk = 1;
    bench.eval();
    bench.clk = 0;
  }
  std::memcpy(&bench.in, in, sizeof bench.in);
  bench.eval();
  std::memcpy(got, &bench.got, sizeof bench.got);
}
}
"""


class Verilated:
    """A simulation in a ``library`` of `kept_library`: `step` takes packed inputs and returns packed outputs."""

    def __init__(self, library: Path, ports: Sequence[Port]) -> None:
        linked = ctypes.CDLL(str(library))
        linked.start.restype = ctypes.c_void_p
        linked.end.argtypes = (ctypes.c_void_p,)
        self._step, self._model = linked.step, linked.start()
        self._step.argtypes = ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_void_p
        self._step.restype = None
        weakref.finalize(self, linked.end, self._model)
        self._size, size = (8 * -(-total_width(group) // 64) for group in split(ports))  # bytes, Verilator's or more
        self._got = ctypes.create_string_buffer(size)

    def step(self, edge: bool, inputs: int) -> int:
        """Settled outputs for the packed ``inputs``; edge: a clock edge with the old inputs comes first."""
        self._step(self._model, edge, inputs.to_bytes(self._size, "little"), self._got)
        return int.from_bytes(self._got, "little")


def kept_library(name: str, top: str, ports: Sequence[Port], text: str) -> Path:
    """Return the kept library that simulates module ``top`` of the Verilog ``text``. Raises ToolError."""
    high_in, high_got = (total_width(group) - 1 for group in split(ports))
    text += BENCH.format(high_in=high_in, high_got=high_got, instance=instance(top, ports))
    folder = FOLDER / f"{name}.{digest(verilator_version(), text, WRAPPER, OPTIONS, CXX, COMPILED)}"
    return cached(folder, lambda part: _compile(part / LIBRARY, text)) / LIBRARY


def _compile(library: Path, text: str) -> None:
    with tempfile.TemporaryDirectory(prefix="talbot-") as work:
        source, wrapper = Path(work) / "verilated.sv", Path(work) / "wrapper.cpp"
        source.write_text(text, encoding="utf-8")
        files = verilate(Path(work), "VerilatedBench", [source], OPTIONS)
        wrapper.write_text(WRAPPER, encoding="utf-8")
        options = *COMPILED, *accepted("-fno-gnu-unique")
        compile_program(library, [*files, wrapper], [*precompiled(*options), *options, "-shared", *runtime()])


def in_verilator(name: str, top: str, ports: Sequence[Port], text: str) -> Verilated:
    """Start module ``top`` of the Verilog ``text`` in Verilator; name: of its library. Raises ToolError."""
    return Verilated(kept_library(name, top, ports, text), ports)
