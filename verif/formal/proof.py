"""A proof of a block: properties, method, and the bug of each property's twin."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from talbot.models.parameters import ArrayParameters, ChipParameters, ParameterError, SensorParameters, TileParameters

METHODS = ("induction", "bounded")
ENGINES = ("boolector", "z3")
LABEL = re.compile(r"\b(\w+)\s*:\s*(assert|assume|cover)\s*\(")
RESET = "a_reset"  # the assumption that every proof makes: it begins in reset


@dataclass(frozen=True)
class Twin:
    """A deliberate bug: ``find``, which must occur once in the exported Verilog, becomes ``replace``.

    wrapper: the text is in the wrapper's sources instead, for a property of the reference itself. depth: steps within
    which the property must fail, by default the proof's twin_depth.
    """

    find: str
    replace: str
    depth: int | None = None
    wrapper: bool = False


@dataclass(frozen=True)
class Owner:
    """What an assumption rests on; neither: it defines a constant of the wrapper (verif.formal.owners).

    proven: PROOF.LABEL, a property of the block that drives the input. names: in the assumption -> in that property.
    contract: a line of the interface contract in docs/chip.md.
    """

    proven: str = ""
    names: dict[str, str] = field(default_factory=dict)
    contract: str = ""


@dataclass(frozen=True)
class Proof:
    """The properties of one wrapper.

    name: unique. block: the top in rtl.tops that its results count for. wrapper: SystemVerilog file. top: its module.
    modules: module under proof -> the exported top or part whose Verilog holds it. sensor: rows, cols, lanes,
    tile_rows, tile_cols, order, divider, n_frac, iterations that differ from the default. method: 'induction' (base
    and step, unbounded) or 'bounded'. depth: steps of the base, and the largest k of the induction. cover_depth,
    twin_depth: steps within which every cover point must be reached and every twin must fail. engines: the first also
    runs covers and twins. timeout: s. generated: names in verif.formal.tables, text put before the wrapper. sources:
    files read before the wrapper. defines: macros of the wrapper. why: reason for the depth. twins: property -> Twin.
    assumptions: label -> what it follows from (but RESET). never: regular
    expression of cover points of its inputs that cannot be reached (verif.formal.freedom) -> the reason. tied: inputs
    of the modules that have a constant, with spaces between -> the reason. size_of: the proof that this one repeats
    at another size: its covers and twins count for both. tested: parameter of the block -> the test of every
    value, where the proofs have some alone (verif.formal.sizes). slow: no test of `make test`.
    free_depth: steps within which the inputs must take their values. free_from: register of
    the wrapper -> value that it begins with there, all others with any; by default they begin in reset.
    """

    name: str
    block: str
    wrapper: Path
    top: str
    modules: dict[str, str]
    method: str
    depth: int
    why: str
    twins: dict[str, Twin]
    assumptions: dict[str, Owner] = field(default_factory=dict)
    never: dict[str, str] = field(default_factory=dict)
    tied: dict[str, str] = field(default_factory=dict)
    sensor: dict[str, Any] = field(default_factory=dict)
    cover_depth: int = 20
    twin_depth: int = 20
    engines: tuple[str, ...] = ("boolector",)
    timeout: float = 300
    generated: tuple[str, ...] = ()
    sources: tuple[Path, ...] = ()
    defines: dict[str, Any] = field(default_factory=dict)
    size_of: str | None = None
    tested: dict[str, str] = field(default_factory=dict)
    slow: bool = False
    free_depth: int = 8
    free_from: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._check("method", self.method, METHODS)
        for engine in self.engines:
            self._check("engines", engine, ENGINES)
        if not self.wrapper.is_file():
            raise ParameterError(f"{self.name}.wrapper = {self.wrapper}: must be a file")

    def _check(self, key: str, value: str, choices: Iterable[str]) -> None:
        if value not in choices:
            raise ParameterError(f"{self.name}.{key} = {value}: must be one of {', '.join(choices)}")

    @property
    def text(self) -> str:
        """Return the text of the sources and the wrapper."""
        return "\n".join(path.read_text(encoding="utf-8") for path in (*self.sources, self.wrapper))

    @property
    def assumed(self) -> tuple[str, ...]:
        """Return the labels of its assumptions."""
        return (RESET, *self.assumptions)

    @property
    def sensor_parameters(self) -> SensorParameters:
        """Return the parameters of the exported design."""
        parameters = dict(self.sensor)
        default = SensorParameters()
        array = ArrayParameters(parameters.pop("rows", default.array.rows), parameters.pop("cols", default.array.cols))
        chip = ChipParameters(
            parameters.pop("lanes", default.chip.lanes),
            parameters.pop("divider", default.chip.divider),
            parameters.pop("n_frac", default.chip.n_frac),
            parameters.pop("iterations", default.chip.cordic_iterations),
        )
        tile = TileParameters.small(
            parameters.pop("tile_rows", default.tile.rows), parameters.pop("tile_cols", default.tile.cols)
        )
        if "order" in parameters:
            tile = replace(tile, order=parameters.pop("order"))
        if parameters:
            raise ParameterError(f"{self.name}.sensor = {', '.join(parameters)}: must be parameters of the sensor")
        return SensorParameters(tile=tile, array=array, chip=chip)


@dataclass(frozen=True)
class Labels:
    """Labels of a wrapper's statements. invariants: assertions that only strengthen the induction, without a twin."""

    properties: list[str]
    invariants: list[str]
    covers: list[str]
    assumptions: list[str]


def labels(text: str) -> Labels:
    """Return the labels of a wrapper; an assertion named inv_... is an invariant.

    Raises ParameterError for an assertion, assumption or cover point without a label, or a label that occurs twice.
    """
    plain = re.sub(r"//.*|/\*[\s\S]*?\*/", "", text)
    statements = LABEL.findall(plain)
    if len(statements) != len(re.findall(r"\b(?:assert|assume|cover|restrict)\b", plain)):
        raise ParameterError("label = none: every assert, assume and cover must have one")
    names = [name for name, _ in statements]
    if len(set(names)) != len(names):
        raise ParameterError(f"label = {', '.join(sorted({n for n in names if names.count(n) > 1}))}: must occur once")
    asserts = [name for name, kind in statements if kind == "assert"]
    return Labels(
        [n for n in asserts if not n.startswith("inv_")],
        [n for n in asserts if n.startswith("inv_")],
        [name for name, kind in statements if kind == "cover"],
        [name for name, kind in statements if kind == "assume"],
    )
