"""The values of a component's ports in every cycle of its tests, as a file to compare a simulation with."""

import importlib
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from pymtl3 import Component

from talbot.base.cache import digest
from talbot.base.files import write
from talbot.rtl.harness.ports import Port, places, split
from talbot.rtl.harness.translate import translate_component


@dataclass
class Trace:
    """Every cycle of the simulators of one component with one parameter set.

    cls, module, arguments: the component is `cls(*arguments)` of `module`. ports: of rtl.harness.ports.ports_of.
    lines: a cycle each, 'fresh inputs outputs': fresh is 1 in a simulator's first cycle, where registers hold
    anything; the rest are hexadecimal numbers packed as rtl.harness.ports.places, settled ahead of the clock edge.
    tests: first cycle and name of each test, ascending. cycles: number of lines in the file, where they are not read.
    """

    cls: str
    module: str
    arguments: tuple[Any, ...]
    ports: tuple[Port, ...]
    lines: list[str] = field(default_factory=list)
    tests: list[tuple[int, str]] = field(default_factory=list)
    cycles: int = 0

    @property
    def name(self) -> str:
        """Return the name of the files: the class and, where it has parameters, a digest of them."""
        if not self.arguments:
            return self.cls
        return f"{self.cls}.{digest(repr(self.arguments))[:8]}"

    def component(self) -> Component:
        """Return the component, not elaborated."""
        return getattr(importlib.import_module(self.module), self.cls)(*self.arguments)

    def verilog(self) -> str:
        """Return the component's Verilog; the module is named `cls`."""
        return translate_component(self.component(), self.cls)

    def test_at(self, cycle: int) -> str:
        """Return the name of the test that drove a cycle."""
        return next((name for first, name in reversed(self.tests) if first <= cycle), "")

    def cycles_of(self, test: str) -> int:
        """Return the cycles of a test, all its simulators together."""
        ends = [first for first, _ in self.tests[1:]] + [self.cycles or len(self.lines)]
        return sum(end - first for (first, name), end in zip(self.tests, ends, strict=True) if name == test)

    def values(self, cycle: int) -> tuple[dict[str, int], ...]:
        """Return inputs and outputs of a cycle, by the port's name in the Verilog."""
        _, *packed = self.lines[cycle].split()
        return tuple(
            {port.name: int(number, 16) >> low & (1 << port.width) - 1 for port, low in places(group).items()}
            for group, number in zip(split(self.ports), packed)
        )

    def save(self, folder: Path | str) -> Path:
        """Write <name>.trace, the cycles, and <name>.json, the rest; returns the path of the .json file."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        head = {
            "cls": self.cls,
            "module": self.module,
            "arguments": self.arguments,
            "cycles": len(self.lines),
            "ports": [asdict(port) for port in self.ports],
            "tests": self.tests,
        }
        write(folder / f"{self.name}.trace", "\n".join(self.lines) + "\n")
        path = folder / f"{self.name}.json"
        write(path, json.dumps(head, indent=1) + "\n")
        return path


def load(path: Path | str, cycles: bool = True) -> Trace:
    """Return the Trace of a .json file that `Trace.save` wrote; without its lines unless ``cycles``."""
    head = json.loads(Path(path).read_text(encoding="utf-8"))
    lines = Path(path).with_suffix(".trace").read_text(encoding="utf-8").splitlines() if cycles else []
    return Trace(
        head["cls"],
        head["module"],
        _tuples(head["arguments"]),
        tuple(Port(**p) for p in head["ports"]),
        lines,
        [tuple(test) for test in head["tests"]],
        head["cycles"],
    )


def _tuples(value: Any) -> Any:
    """Return lists of JSON as tuples."""
    return tuple(map(_tuples, value)) if isinstance(value, list) else value
