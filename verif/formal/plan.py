"""The jobs of a proof, planned such that a change of one block keeps the results of the others."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from talbot.base.jobs import Job
from talbot.verif.formal import design
from talbot.verif.formal.engine import version
from talbot.verif.formal.freedom import FreedomResult, freedom
from talbot.verif.formal.necessity import ConjunctResult, NecessityResult, conjuncts, necessity
from talbot.verif.formal.proof import Proof
from talbot.verif.formal.prove import CoverResult, ProofResult, TwinResult, cover, prove, twin


@dataclass(frozen=True)
class Piece:
    """One job of a proof. kind: the class of its result. name: the engine, the property or the check."""

    kind: type[ProofResult | CoverResult | TwinResult | NecessityResult | FreedomResult | ConjunctResult]
    name: str
    job: Job


def pieces(proof: Proof, engines: Iterable[str], assumptions: bool = True) -> Iterator[Piece]:
    """Yield every piece of a proof by ``engines``. Raises ParameterError, FormalError.

    assumptions: whether each must be needed and leave all pairs of inputs free, as at the first size of a wrapper. At
    the others their conjuncts are listed, and each input must be free.
    """
    texts, wrapper = design.exported(proof), design.wrapper(proof)
    base = (*sorted(texts.values()), wrapper, proof.top, proof.method, proof.timeout, *proof.assumed)
    for engine in engines:
        inputs = (*base, proof.depth, version("yosys"), version(engine))
        job = Job(f"{proof.name}.{engine}", prove, (proof, engine, texts, wrapper), inputs)
        yield Piece(ProofResult, engine, job)
    if assumptions:
        job = Job(f"{proof.name}.necessity", necessity, (proof, texts, wrapper), (*base, proof.depth))
        yield Piece(NecessityResult, "necessity", job)
    else:
        job = Job(f"{proof.name}.conjuncts", conjuncts, (proof, texts, wrapper), base)
        yield Piece(ConjunctResult, "conjuncts", job)
    listed = str((proof.free_depth, proof.free_from, proof.never, proof.tied, assumptions))
    job = Job(f"{proof.name}.freedom", freedom, (proof, texts, wrapper, assumptions), (*base, listed))
    yield Piece(FreedomResult, "freedom", job)
    if proof.size_of:
        return
    job = Job(f"{proof.name}.cover", cover, (proof, texts, wrapper), (*base, proof.cover_depth))
    yield Piece(CoverResult, "cover", job)
    for label, bug in proof.twins.items():
        bad, around = design.broken(proof, texts, wrapper, label)
        inputs = (*base, *sorted(bad.values()), around, bug.depth or proof.twin_depth)
        yield Piece(TwinResult, label, Job(f"{proof.name}.{label}", twin, (proof, label, bad, around), inputs))
