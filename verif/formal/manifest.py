"""Proofs as rtl/<block>/formal/proofs.yaml declares them: what is proven, how, and the bug of each property's twin."""

from pathlib import Path
from typing import Any

import yaml

from base.paths import ROOT
from models.parameters import ParameterError
from rtl.tops import TOPS

from .proof import ENGINES, Proof, Twin, labels


def read(path: Path) -> list[Proof]:
    """Return the proofs of one file. Raises ParameterError."""
    try:
        entries = yaml.safe_load(path.read_text())
        return [_proof(path.parent, entry) for entry in entries]
    except (yaml.YAMLError, TypeError, KeyError) as error:
        raise ParameterError(f"{path} = {str(error).splitlines()[0]}: must be a list of proofs (README.md)") from None


def _proof(folder: Path, entry: dict[str, Any]) -> Proof:
    entry = dict(entry)
    entry["wrapper"] = folder / entry["wrapper"]
    entry["twins"] = {name: Twin(**twin) for name, twin in entry["twins"].items()}
    for key in ("engines", "generated", "sources"):
        entry[key] = tuple(entry.get(key, ()))
    entry["engines"] = entry["engines"] or ENGINES[:1]
    entry["sources"] = tuple(folder / name for name in entry["sources"])
    proof = Proof(**entry)
    if proof.block not in TOPS:
        raise ParameterError(f"{proof.name}.block = {proof.block}: must be one of {', '.join(TOPS)}")
    named = labels(proof.text)
    if set(named.properties) != set(proof.twins):
        odd = ", ".join(sorted(set(named.properties) ^ set(proof.twins)))
        raise ParameterError(f"{proof.name}.twins = {odd}: every property must have a twin, and every twin a property")
    if not named.covers:
        raise ParameterError(f"{proof.name}.wrapper = no cover point: must have one")
    return proof


def every() -> list[Proof]:
    """Return all proofs of the repository in the order of the blocks in rtl.tops."""
    proofs = [proof for path in sorted(ROOT.glob("rtl/*/formal/proofs.yaml")) for proof in read(path)]
    names = [proof.name for proof in proofs]
    if len(set(names)) != len(names):
        raise ParameterError(f"proofs = {', '.join(n for n in set(names) if names.count(n) > 1)}: must occur once")
    return sorted(proofs, key=lambda proof: list(TOPS).index(proof.block))
