"""The jobs of a proof: what is proven is planned here, so that a change of one block leaves the others' results."""

from base.jobs import Job

from . import design
from .engine import version
from .prove import cover, prove, twin


def jobs(proof, engines):
    """Every job of a proof by ``engines``: list of (kind, label or engine, Job). Raises ParameterError, FormalError."""
    texts, wrapper = design.exported(proof), design.wrapper(proof)
    base = (*sorted(texts.values()), wrapper, proof.top, proof.method, proof.timeout)
    found = []
    for engine in engines:
        found.append(
            (
                "proof",
                engine,
                Job(
                    f"{proof.name}.{engine}",
                    prove,
                    (proof, engine, texts, wrapper),
                    (*base, proof.depth, version("yosys"), version(engine)),
                ),
            )
        )
    found.append(("cover", "", Job(f"{proof.name}.cover", cover, (proof, texts, wrapper), (*base, proof.cover_depth))))
    for label, bug in proof.twins.items():
        bad, around = design.broken(proof, texts, wrapper, label)
        found.append(
            (
                "twin",
                label,
                Job(
                    f"{proof.name}.{label}",
                    twin,
                    (proof, label, bad, around),
                    (*base, *sorted(bad.values()), around, bug.depth or proof.twin_depth),
                ),
            )
        )
    return found
