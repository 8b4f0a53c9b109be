"""The sizes of the blocks: what can be built (rtl.sizes refuses the rest), and what is proven or tested for all."""

import inspect
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache

from talbot.base.paths import ROOT
from talbot.base.table import markdown_table
from talbot.models.parameters import SensorParameters
from talbot.rtl.sizes import BLOCKS, BUILD
from talbot.rtl.tops import TOPS, build_top
from talbot.verif.formal.proof import Proof

FEW = 32  # values of a parameter, each of which must be proven; of more, the ends and some between


@dataclass(frozen=True)
class Size:
    """A parameter of a block. allowed: values to build it with. proven: those of its proofs. test: of all, or none."""

    block: str
    parameter: str
    allowed: Sequence[object]
    proven: tuple[object, ...]
    test: str

    @property
    def missing(self) -> list[object]:
        """Return the values that must be proven and are not."""
        if self.test:
            return []
        few = len(self.allowed) <= FEW
        required = [*self.allowed] if few else [self.allowed[0], self.allowed[-1]]
        missing = [value for value in required if value not in self.proven]
        return missing or ([] if few or len(self.proven) > len(required) else ["a value between"])


def _text(values: Sequence[object]) -> str:
    return f"{values[0]}..{values[-1]}" if isinstance(values, range) else ", ".join(map(str, values))


@cache
def parameters(block: str) -> tuple[str, ...]:
    """Return the parameters of a block's `construct` that have a range."""
    construct = type(build_top(block, SensorParameters())).construct
    return tuple(name for name in inspect.signature(construct).parameters if name in BUILD)


def sizes(proofs: Iterable[Proof]) -> list[Size]:
    """Return every parameter of every block."""
    proofs = list(proofs)
    every = []
    for block in TOPS:
        of_block = [proof for proof in proofs if proof.block == block]
        about = [proof for proof in proofs if proof.block == block or block in proof.modules]
        for name in parameters(block):
            values = {_value(proof.sensor_parameters, name) for proof in about}
            allowed = BLOCKS.get(block, BUILD)[name]
            proven = tuple(value for value in allowed if value in values)
            tests = [proof.tested[name] for proof in of_block if name in proof.tested]
            every.append(Size(block, name, allowed, proven, tests[0] if tests else ""))
    return every


def _value(sensor: SensorParameters, name: str) -> object:
    array, tile, chip = sensor.array, sensor.tile, sensor.chip
    values = {"rows": array.rows, "cols": array.cols, "tile_rows": tile.rows, "tile_cols": tile.cols}
    chips = {"lanes": chip.lanes, "divider": chip.divider, "n_frac": chip.n_frac}
    return (values | chips | {"iterations": chip.cordic_iterations})[name]


def problems(proofs: Iterable[Proof]) -> list[str]:
    """Return a line for each value that can be built and is neither proven nor tested, and for each missing test."""
    return [
        *(
            f"{size.block}.{size.parameter} = {', '.join(map(str, size.missing))}: must be proven, tested or refused"
            for size in sizes(proofs)
            if size.missing
        ),
        *(
            f"{proof.name}.tested.{name} = {test}: must be a test of a parameter of {proof.block}"
            for proof in proofs
            for name, test in proof.tested.items()
            if name not in parameters(proof.block) or not (ROOT / test.split("::")[0]).is_file()
        ),
    ]


def table(proofs: Iterable[Proof]) -> str:
    """Return the values that a parameter may have as a Markdown table, blocks with the same values in one row."""
    blocks: dict[tuple[str, str], list[str]] = {}
    for size in sizes(proofs):
        blocks.setdefault((size.parameter, _text(size.allowed)), []).append(size.block)
    rows = ((*values, ", ".join(names)) for values, names in blocks.items())
    return markdown_table(("parameter", "can be built with", "blocks"), rows)
