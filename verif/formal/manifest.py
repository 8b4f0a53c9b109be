"""rtl/<block>/formal/proofs.yaml: what is proven, how, and how the design is broken for each property's twin."""

from dataclasses import dataclass, field
from pathlib import Path

import yaml

from base.paths import ROOT
from models.parameters import ArrayParameters, ChipParameters, ParameterError, SensorParameters
from rtl.tops import TOPS

from .engine import labels

METHODS = ("induction", "bounded")
ENGINES = ("boolector", "z3")


@dataclass(frozen=True)
class Twin:
    """A deliberate bug: ``find``, which must occur once in the exported Verilog, becomes ``replace``.

    wrapper: it lies in the wrapper's sources instead, for a property of the reference itself. depth: steps within
    which the failure lies, if not the proof's twin_depth.
    """

    find: str
    replace: str
    depth: int | None = None
    wrapper: bool = False


@dataclass(frozen=True)
class Proof:
    """The properties of one wrapper.

    name: unique. block: the top in rtl.tops that its results count for. wrapper: SystemVerilog file. top: its
    module. modules: module under proof -> the exported top whose Verilog holds it. sensor: rows, cols, lanes,
    divider, n_frac, iterations that differ from the default. method: 'induction' (base and step, unbounded) or
    'bounded'. depth: steps of the base; induction is tried up to it. cover_depth, twin_depth: steps within which every
    cover point and every twin's failure must lie. engines: the first also serves covers and twins. timeout: s.
    generated: names in verif.formal.tables, text put before the wrapper.
    sources: files read before the wrapper. defines: macros of the wrapper.
    why: what the depth rests on. twins: property -> Twin.
    """

    name: str
    block: str
    wrapper: Path
    top: str
    modules: dict
    method: str
    depth: int
    why: str
    twins: dict
    sensor: dict = field(default_factory=dict)
    cover_depth: int = 20
    twin_depth: int = 20
    engines: tuple = ("boolector",)
    timeout: int = 300
    generated: tuple = ()
    sources: tuple = ()
    defines: dict = field(default_factory=dict)

    def __post_init__(self):
        self._check("block", self.block, TOPS)
        self._check("method", self.method, METHODS)
        for engine in self.engines:
            self._check("engines", engine, ENGINES)
        if not self.wrapper.is_file():
            raise ParameterError(f"{self.name}.wrapper = {self.wrapper}: must be a file")

    def _check(self, key, value, choices):
        if value not in choices:
            raise ParameterError(f"{self.name}.{key} = {value}: must be one of {', '.join(choices)}")

    @property
    def text(self):
        """The sources and the wrapper."""
        return "\n".join(path.read_text() for path in (*self.sources, self.wrapper))

    @property
    def sensor_parameters(self):
        """SensorParameters that the design is exported for."""
        given = dict(self.sensor)
        default = SensorParameters()
        array = ArrayParameters(given.pop("rows", default.array.rows), given.pop("cols", default.array.cols))
        chip = ChipParameters(
            given.pop("lanes", default.chip.lanes),
            given.pop("divider", default.chip.divider),
            given.pop("n_frac", default.chip.n_frac),
            given.pop("iterations", default.chip.cordic_iterations),
        )
        if given:
            raise ParameterError(f"{self.name}.sensor = {', '.join(given)}: must be parameters of the sensor")
        return SensorParameters(array=array, chip=chip)


def read(path):
    """The proofs of one file: list of Proof. Raises ParameterError."""
    try:
        entries = yaml.safe_load(path.read_text())
        return [_proof(path.parent, entry) for entry in entries]
    except (yaml.YAMLError, TypeError, KeyError) as error:
        raise ParameterError(f"{path} = {str(error).splitlines()[0]}: must be a list of proofs (README.md)") from None


def _proof(folder, entry):
    entry = dict(entry)
    entry["wrapper"] = folder / entry["wrapper"]
    entry["twins"] = {name: Twin(**twin) for name, twin in entry["twins"].items()}
    for key in ("engines", "generated", "sources"):
        entry[key] = tuple(entry.get(key, ()))
    entry["engines"] = entry["engines"] or ENGINES[:1]
    entry["sources"] = tuple(folder / name for name in entry["sources"])
    proof = Proof(**entry)
    properties, _, covers = labels(proof.text)
    if set(properties) != set(proof.twins):
        odd = ", ".join(sorted(set(properties) ^ set(proof.twins)))
        raise ParameterError(f"{proof.name}.twins = {odd}: every property must have a twin, and every twin a property")
    if not covers:
        raise ParameterError(f"{proof.name}.wrapper = no cover point: must have one, to show that it can be reached")
    return proof


def every():
    """All proofs of the repository: list of Proof, in the order of the blocks in rtl.tops."""
    proofs = [proof for path in sorted(ROOT.glob("rtl/*/formal/proofs.yaml")) for proof in read(path)]
    names = [proof.name for proof in proofs]
    if len(set(names)) != len(names):
        raise ParameterError(f"proofs = {', '.join(n for n in set(names) if names.count(n) > 1)}: must occur once")
    return sorted(proofs, key=lambda proof: list(TOPS).index(proof.block))
