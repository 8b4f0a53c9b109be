"""Proofs declared in rtl/<block>/formal/proofs.yaml: properties, method, and the bug of each property's twin."""

from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import yaml

from talbot.base.paths import PACKAGE
from talbot.models.parameters import ParameterError
from talbot.rtl.tops import TEST_CHIP_1, TOPS
from talbot.verif.formal.owners import parse
from talbot.verif.formal.proof import ENGINES, RESET, Proof, Twin, labels

BLOCKS = *TOPS, *TEST_CHIP_1  # with proofs
SIZE = "rows", "cols", "lanes", "tile_rows", "tile_cols"


def read(path: Path) -> list[Proof]:
    """Return the proofs of one file. Raises ParameterError."""
    try:
        entries = yaml.safe_load(path.read_text(encoding="utf-8"))
        return [_proof(path.parent, sized) for entry in entries for sized in _sizes(entry)]
    except (yaml.YAMLError, TypeError, KeyError) as error:
        raise ParameterError(
            f"{path} = {str(error).splitlines()[0]}: must be a list of proofs (verif/formal/README.md)"
        ) from None


def _sizes(entry: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield a proof for each of its `sizes`, named after it.

    A mapping (parameter of the sensor -> values) names every combination. A list names the SIZE of each, the tile only
    where it is not the default one: the first has the covers and the twins; the first engine alone proves the others.
    """
    fields = {key: value for key, value in entry.items() if key != "sizes"}
    sizes = entry.get("sizes", {})
    if isinstance(sizes, list):
        names = [f"{entry['name']}_{size[0]}x{'_'.join(map(str, size[1:]))}" for size in sizes]
        for name, size in zip(names, sizes, strict=True):
            sized = fields | {"name": name, "sensor": dict(zip(SIZE, size))}
            yield sized | ({"size_of": names[0], "engines": fields["engines"][:1]} if name != names[0] else {})
        return
    for values in product(*sizes.values()):
        name = "_".join([entry["name"], "x".join(map(str, values))] if values else [entry["name"]])
        yield fields | {"name": name, "sensor": fields.get("sensor", {}) | dict(zip(sizes, values, strict=True))}


def _proof(folder: Path, entry: dict[str, Any]) -> Proof:
    entry = dict(entry)
    entry["wrapper"] = folder / entry["wrapper"]
    entry["assumptions"] = {label: parse(label, owner) for label, owner in entry.get("assumptions", {}).items()}
    entry["twins"] = {name: Twin(**twin) for name, twin in entry["twins"].items()}
    for key in ("engines", "generated", "sources"):
        entry[key] = tuple(entry.get(key, ()))
    entry["engines"] = entry["engines"] or ENGINES[:1]
    entry["sources"] = tuple(folder / name for name in entry["sources"])
    proof = Proof(**entry)
    if proof.block not in BLOCKS:
        raise ParameterError(f"{proof.name}.block = {proof.block}: must be one of {', '.join(BLOCKS)}")
    named = labels(proof.text)
    if set(named.properties) != set(proof.twins):
        odd = ", ".join(sorted(set(named.properties) ^ set(proof.twins)))
        raise ParameterError(f"{proof.name}.twins = {odd}: every property must have a twin, and every twin a property")
    if odd := set(named.assumptions) - {RESET} ^ set(proof.assumptions):
        raise ParameterError(
            f"{proof.name}.assumptions = {', '.join(sorted(odd))}: each in the wrapper must be listed with its owner"
        )
    if not named.covers:
        raise ParameterError(f"{proof.name}.wrapper = no cover point: must have one")
    return proof


def every() -> list[Proof]:
    """Return all proofs of the repository in the order of the blocks in rtl.tops."""
    proofs = [proof for path in sorted(PACKAGE.glob("rtl/*/formal/proofs.yaml")) for proof in read(path)]
    names = [proof.name for proof in proofs]
    if len(set(names)) != len(names):
        raise ParameterError(f"proofs = {', '.join(n for n in set(names) if names.count(n) > 1)}: must occur once")
    return sorted(proofs, key=lambda proof: BLOCKS.index(proof.block))
