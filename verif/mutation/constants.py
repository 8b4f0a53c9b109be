"""Constants that models and RTL share, each changed for both: a witness typed from a document or the thesis must fail.

A test that compares models with RTL, or with a text generated from the same table, cannot fail. WITNESSES is the table.
"""

import ast
import random
import re
from collections.abc import Iterable, Iterator
from itertools import pairwise

from talbot.base.jobs import Job
from talbot.base.paths import ROOT
from talbot.base.sources import code
from talbot.models.parameters.registers import array_resets, register_map
from talbot.verif.mutation.planted import Planted, attempt, count

DEFAULTS = "verif/mutation/test/defaults_test.py"
LIMITS, TILE = "models/parameters/test/limits_test.py", "models/parameters/test/tile_test.py"
DRIVER = "rtl/reg_file/test/document_driver_test.py::TestFL"
FRAME = "rtl/run_length/test/paper_frame_test.py"
WITNESSES = {  # file of the constants -> block whose results count them, tests
    "models/parameters/array.py": ("ReadoutSeq", (DEFAULTS, LIMITS, TILE)),
    "models/parameters/chip.py": ("AdcBank", (DEFAULTS, LIMITS)),
    "models/parameters/divider.py": ("PhasePath", (DEFAULTS, LIMITS, "models/digital/test/divider_test.py")),
    "models/parameters/frame.py": ("RegFile", (DEFAULTS, LIMITS)),
    "models/parameters/stream_format.py": ("RunLength", (FRAME,)),
    "models/parameters/tile.py": ("AspChip", (DEFAULTS, TILE, LIMITS)),
    "models/parameters/registers/asp_chip.rdl": ("RegFile", (DRIVER,)),
}
FREE = {  # assignments and functions without a shared constant
    "SHORT_TIMING": "any short durations",
    "SPI_INPUTS": "pins, by name",
    "exposing": "the meaning of a mode, in the proofs of ReadoutSeq",
    "of_rows": "counts",
    "pitch_um": "a unit",
    "small": "its constructor checks the same",
    "_type_map": "shapes",
    "type_map": "shapes",
}
SAMPLE = 24  # of each run of `talbot mutate`


def constants() -> list[Planted]:
    """Return every constant of WITNESSES with one change."""
    out = []
    for file, (block, tests) in WITNESSES.items():
        text = (ROOT / file).read_text(encoding="utf-8")
        changed = _registers(text) if file.endswith(".rdl") else _python(text)
        out += [
            Planted(f"constant {file.split('/')[-1]}: {name}", block, file, ((text, new),), tests)
            for name, new in changed
        ]
    return out


def jobs(blocks: Iterable[str], factor: float, seed: int) -> list[tuple[str, Job]]:
    """Return (block, Job) for a seeded sample of the constants of ``blocks``. factor: of its size."""
    every = [bug for bug in constants() if bug.block in set(blocks)]
    picked = random.Random(seed).sample(every, min(len(every), round(factor * SAMPLE)))
    return [
        (
            bug.block,
            Job(
                re.sub(r"\W+", "-", bug.name),
                is_noticed,
                (bug,),
                (bug.text(), code(*(test.split("::")[0] for test in bug.tests))),
            ),
        )
        for bug in picked
    ]


def is_noticed(bug: Planted) -> bool:
    """Return whether a witness fails, or a parameter is refused. Other tests that cannot run with it are none."""
    output = attempt(bug, "--continue-on-collection-errors").stdout
    return count("failed", output) > 0 or "ParameterError: " in output


def _python(text: str) -> Iterator[tuple[str, str]]:
    """Yield (name, changed text) for each number and each pair of neighbours of a tuple of names or a permutation."""
    tree, lines = ast.parse(text), text.splitlines(keepends=True)
    begin = [sum(map(len, lines[:i])) for i in range(len(lines))]

    def span(node: ast.expr) -> tuple[int, int]:
        assert node.end_lineno and node.end_col_offset
        return begin[node.lineno - 1] + node.col_offset, begin[node.end_lineno - 1] + node.end_col_offset

    def replaced(*changes: tuple[ast.expr, str]) -> str:
        out = text
        for node, new in reversed(changes):
            first, past = span(node)
            out = out[:first] + new + out[past:]
        return out

    exchanged = set()
    for node in ast.walk(tree):
        if _name(node) in FREE or isinstance(node, ast.JoinedStr):
            exchanged |= set(ast.walk(node))
    for node in (item.value for item in tree.body if isinstance(item, ast.Assign)):
        if isinstance(node, ast.Tuple) and node not in exchanged:
            values = [getattr(item, "value", None) for item in node.elts]
            if (
                all(isinstance(v, str) for v in values)
                or len(values) > 2
                and sorted(map(str, values)) == sorted(map(str, range(len(values))))
            ):
                exchanged |= set(node.elts)
                for a, b in pairwise(node.elts):
                    new = replaced((a, ast.unparse(b)), (b, ast.unparse(a)))
                    yield f"line {a.lineno}: {ast.unparse(a)} and {ast.unparse(b)} exchanged", new
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or node in exchanged:
            continue
        value = node.value
        if isinstance(value, int | float) and not isinstance(value, bool):
            new = repr(value + 1 if isinstance(value, int) else value * 1.5 or 1.5)
            yield f"line {node.lineno}, {node.col_offset}: {text[slice(*span(node))]} is {new}", replaced((node, new))


def _name(node: ast.AST) -> str | None:
    return getattr(node.targets[0], "id", None) if isinstance(node, ast.Assign) else getattr(node, "name", None)


def _registers(text: str) -> Iterator[tuple[str, str]]:
    """Yield (name, changed text): addresses, bits of two neighbours; reset values that a register keeps."""
    registers = [*re.finditer(r"regwidth = (\d+);\s*(?=[^@]*@)|\} (\w+)(?:\[\d+\])? @ (0x\w+)", text)]
    sized = []  # (match of the address, bits)
    width = "8"
    for match in registers:
        if match[1]:
            width = match[1]
        else:
            sized.append((match, width))
            width = "8"
    for (a, bits), (b, others) in pairwise(sized):
        if bits == others and a[2] != "trim" != b[2]:
            yield f"{a[2]} and {b[2]} exchanged", _exchanged(text, a.span(3), b.span(3))
    reset = r"(\w+)\[(?:\d+|`TRIM_BITS - 1):(\d+)\](?: = (0x\w+|\d+))?;"
    fields = [*re.finditer(reset, text)]
    for a, b in pairwise(fields):
        if "reg {" not in text[a.end() : b.start()] and "reg\n" not in text[a.end() : b.start()]:
            yield f"{a[1]} and {b[1]} exchanged", _exchanged(text, a.span(1), b.span(1))
    chip, by_array = register_map(), array_resets(1, 1, 1)
    stored = {f.name for f in (*chip.configuration, *chip.identity)} - set(by_array)
    for field in fields:
        if field[1] in stored:
            first, past = field.span(3)
            new = str(int(field[3], 0) ^ 1)
            yield f"{field[1]} resets to {new}", text[:first] + new + text[past:]
    yield "a bit less of each trim", text.replace("TRIM_BITS 10", "TRIM_BITS 9")


def _exchanged(text: str, a: tuple[int, int], b: tuple[int, int]) -> str:
    return text[: a[0]] + text[slice(*b)] + text[a[1] : b[0]] + text[slice(*a)] + text[b[1] :]
