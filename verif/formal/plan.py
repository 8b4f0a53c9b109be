"""The jobs of a proof: what is proven is planned here, so that a change of one block leaves the others' results."""

from collections.abc import Iterable
from dataclasses import dataclass

from base.jobs import Job

from . import design
from .engine import version
from .proof import Proof
from .prove import CoverResult, ProofResult, TwinResult, cover, prove, twin


@dataclass(frozen=True)
class Piece:
    """One job of a proof. kind: the class of its result. name: the engine or the property."""

    kind: type[ProofResult | CoverResult | TwinResult]
    name: str
    job: Job


def pieces(proof: Proof, engines: Iterable[str]) -> list[Piece]:
    """Return every piece of a proof by ``engines``. Raises ParameterError, FormalError."""
    texts, wrapper = design.exported(proof), design.wrapper(proof)
    base = (*sorted(texts.values()), wrapper, proof.top, proof.method, proof.timeout)
    found = []
    for engine in engines:
        inputs = (*base, proof.depth, version("yosys"), version(engine))
        job = Job(f"{proof.name}.{engine}", prove, (proof, engine, texts, wrapper), inputs)
        found.append(Piece(ProofResult, engine, job))
    job = Job(f"{proof.name}.cover", cover, (proof, texts, wrapper), (*base, proof.cover_depth))
    found.append(Piece(CoverResult, "cover", job))
    for label, bug in proof.twins.items():
        bad, around = design.broken(proof, texts, wrapper, label)
        inputs = (*base, *sorted(bad.values()), around, bug.depth or proof.twin_depth)
        found.append(Piece(TwinResult, label, Job(f"{proof.name}.{label}", twin, (proof, label, bad, around), inputs)))
    return found
