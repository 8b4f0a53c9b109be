"""The jobs of a proof, planned such that a change of one block keeps the results of the others."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from talbot.base.jobs import Job
from talbot.verif.formal import design
from talbot.verif.formal.engine import version
from talbot.verif.formal.freedom import FreedomResult, freedom
from talbot.verif.formal.necessity import ConjunctResult, NecessityResult, conjuncts, necessity
from talbot.verif.formal.proof import Proof
from talbot.verif.formal.prove import CoverResult, ProofResult, TwinResult, cover, prove, twin

COMBINATIONAL = 4  # cover_depth up to which the inputs are checked at every size


@dataclass(frozen=True)
class Piece:
    """One job of a proof. kind: the class of its result. name: the engine, the property or the check."""

    kind: type[ProofResult | CoverResult | TwinResult | NecessityResult | FreedomResult | ConjunctResult]
    name: str
    job: Job


def pieces(proof: Proof, engines: Iterable[str], assumptions: bool = True) -> Iterator[Piece]:
    """Yield every piece of a proof by ``engines``. Raises ParameterError, FormalError.

    assumptions: whether each must be needed and leave the inputs free, as at the first size of a wrapper. At the others
    their conjuncts are listed, and the inputs of combinational blocks must be free.
    """
    texts, wrapper = design.exported(proof), design.wrapper(proof)
    base = (*sorted(texts.values()), wrapper, proof.top, proof.method, proof.timeout, *proof.assumed)
    for engine in engines:
        inputs = (*base, proof.depth, version("yosys"), version(engine))
        job = Job(f"{proof.name}.{engine}", prove, (proof, engine, texts, wrapper), inputs)
        yield Piece(ProofResult, engine, job)
    checks: list[tuple[type[NecessityResult | ConjunctResult | FreedomResult], Callable[..., object], object]] = [
        (NecessityResult, necessity, proof.depth) if assumptions else (ConjunctResult, conjuncts, 0)
    ]
    if assumptions or proof.cover_depth <= COMBINATIONAL:
        checks.append((FreedomResult, freedom, str((proof.free_depth, proof.free_from, proof.never, proof.tied))))
    for kind, call, more in checks:
        job = Job(f"{proof.name}.{call.__name__}", call, (proof, texts, wrapper), (*base, more))
        yield Piece(kind, call.__name__, job)
    if proof.size_of:
        return
    job = Job(f"{proof.name}.cover", cover, (proof, texts, wrapper), (*base, proof.cover_depth))
    yield Piece(CoverResult, "cover", job)
    for label, bug in proof.twins.items():
        bad, around = design.broken(proof, texts, wrapper, label)
        inputs = (*base, *sorted(bad.values()), around, bug.depth or proof.twin_depth)
        yield Piece(TwinResult, label, Job(f"{proof.name}.{label}", twin, (proof, label, bad, around), inputs))
