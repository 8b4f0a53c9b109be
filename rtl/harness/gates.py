"""A block as two-input gates, simulated in many copies in parallel: a bit of a machine word for each copy.

Yosys makes the gates from the exported Verilog, and the C++ compiler makes one function of them, a line for each gate,
which computes 512 copies at a time: all 2^26 requests of a divider take seconds. Registers begin with random bits.
"""

import ctypes
import json
import re
import shutil
import tempfile
from pathlib import Path

import numpy as np
import numpy.typing as npt
from pymtl3 import Component

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD
from talbot.base.sources import code
from talbot.base.tools import located, run
from talbot.base.verilator import CXX, accepted
from talbot.rtl.harness.ports import ports_of, split
from talbot.rtl.harness.translate import translate_component

Words = npt.NDArray[np.uint64]
ALL = np.uint64(2**64 - 1)
WIDE = 512  # copies that one machine instruction computes at most

SCRIPT = """read_verilog -sv top.v; hierarchy -check -top {top}; proc; opt_expr; opt_clean; techmap -map shiftx.v;
opt_expr; opt_clean; techmap; opt_expr; opt_clean; flatten; dffunmap; abc -g AND; aigmap; opt_clean;
write_aiger -ascii -symbols gates.aag"""
SHIFTX = Path(__file__).parent / "shiftx.v"

# The last two: passes of GCC whose time grows much faster than the function
OPTIONS = "-O1", "-march=native", "-fdisable-rtl-combine", "-fira-algorithm=priority"
ONE, PART = 2000, 64  # lines that make one function, which is fastest; lines of each function otherwise

HEAD = """#include <cstdint>
typedef std::uint64_t Wide __attribute__((vector_size(64), aligned(8), may_alias));
"""
ARGUMENTS = "const Wide* in, Wide* state, Wide* out, long n"


class Gates:
    """``copies`` of a component with separate inputs; a multiple of WIDE.

    A port's value is an array (width, copies / 64) of uint64, bit i of the port in row i: see `packed`, `unpacked`.
    """

    def __init__(self, component: Component, copies: int) -> None:
        """Build the gates, or take them from an earlier run. Raises ToolError."""
        top = type(component).__name__
        verilog = translate_component(component, top)
        inputs, outputs = split(ports_of(component))
        machine = run([*CXX, *accepted("-march=native"), "-E", "-dM", "-x", "c++", "/dev/null"])
        key = digest(code(__name__), verilog, machine)
        folder = cached(BUILD / "gates" / key, lambda folder: _compile(folder, verilog, top))
        rows = json.loads((folder / "rows.json").read_text(encoding="utf-8"))
        self._cycle = ctypes.CDLL(str(folder / "gates.so")).cycle
        self.copies = copies
        self._in, self._out = (np.zeros((len(rows[kind]), copies // 64), np.uint64) for kind in "io")
        self._state = np.random.default_rng(1).integers(0, 2**64, (rows["state"], copies // 64), np.uint64)
        self._rows: dict[str, list[int]] = {}
        for port in (*inputs, *outputs):
            bits = [port.name] if port.width == 1 else [f"{port.name}[{i}]" for i in range(port.width)]
            self._rows[port.path] = [rows["o" if port.output else "i"][bit] for bit in bits]

    def __setitem__(self, path: str, value: Words | int) -> None:
        """Set an input: the copies' values, or one value for all."""
        rows = self._rows[path]
        if isinstance(value, np.ndarray):
            self._in[rows] = value
        else:
            for i, row in enumerate(rows):
                self._in[row] = ALL if value >> i & 1 else 0

    def __getitem__(self, path: str) -> Words:
        """Return an output as it was ahead of the last clock edge."""
        return self._out[self._rows[path]]

    def tick(self) -> None:
        """Compute the outputs, then the clock edge."""
        arrays = (ctypes.c_void_p(a.ctypes.data) for a in (self._in, self._state, self._out))
        self._cycle(*arrays, ctypes.c_long(self.copies // WIDE))


def packed(values: npt.ArrayLike, width: int = 1) -> Words:
    """Return the ``values`` of the copies (copies,) as an array (width, copies / 64)."""
    bits = np.asarray(values) >> np.arange(width)[:, None] & 1
    return np.packbits(bits.astype(np.uint8), axis=1, bitorder="little").view(np.uint64)


def unpacked(words: Words) -> npt.NDArray[np.int64]:
    """Return the copies' values (copies,) of an array (width, copies / 64)."""
    bits = np.unpackbits(words.view(np.uint8), axis=1, bitorder="little")
    return (bits.astype(np.int64) << np.arange(len(bits))[:, None]).sum(axis=0)


def _compile(folder: Path, verilog: str, top: str) -> None:
    with tempfile.TemporaryDirectory(prefix="talbot-") as work:
        (Path(work) / "top.v").write_text(verilog, encoding="utf-8")
        shutil.copy(SHIFTX, work)  # its own path may have a space
        run([located("yosys") or "yosys", "-q", "-p", SCRIPT.format(top=top).replace("\n", " ")], cwd=work)
        lines = iter((Path(work) / "gates.aag").read_text(encoding="utf-8").splitlines())
    _, n_in, n_state, n_out, n_gates = map(int, next(lines).split()[1:])
    inputs, state, outputs, gates = (
        [[int(word) for word in next(lines).split()] for _ in range(count)] for count in (n_in, n_state, n_out, n_gates)
    )
    large = n_state + n_gates > ONE
    name, declared = ("v[{}]", "") if large else ("v{}", "const Wide ")

    def value(v: int) -> str:
        return f"{'~' if v & 1 else ''}{name.format(v // 2) if v > 1 else '(Wide{})'}"

    body = [f"{declared}{value(v)} = in[{i} * n + at];" for i, (v,) in enumerate(inputs)]
    body += [f"{declared}{value(v)} = state[{i} * n + at];" for i, (v, *_) in enumerate(state)]
    body += [f"{declared}{value(v)} = {value(a)} & {value(b)};" for v, a, b in gates]
    body += [f"out[{i} * n + at] = {value(v)};" for i, (v,) in enumerate(outputs)]
    body += [f"state[{i} * n + at] = {value(v)};" for i, (_, v, *_) in enumerate(state)]
    text = [HEAD]
    if large:
        starts = range(0, len(body), PART)
        text.append(f"static Wide v[{n_in + n_state + n_gates + 1}];")
        for i in starts:
            text += [f"static void part{i}({ARGUMENTS}, long at) {{", *body[i : i + PART], "}"]
        body = [f"part{i}(in, state, out, n, at);" for i in starts]
    text += [f'extern "C" void cycle({ARGUMENTS}) {{', "for (long at = 0; at < n; ++at) {", *body, "}", "}"]
    (folder / "gates.cpp").write_text("\n".join(text), encoding="utf-8")
    run([*CXX, *accepted(*OPTIONS), "-shared", "-fPIC", folder / "gates.cpp", "-o", folder / "gates.so"])
    symbols = [match.groups() for line in lines if (match := re.match(r"([io])(\d+) (\S+)$", line))]
    rows = {kind: {name: int(row) for symbol, row, name in symbols if symbol == kind} for kind in "io"}
    (folder / "rows.json").write_text(json.dumps(rows | {"state": n_state}), encoding="utf-8")
