"""The proofs of a block as tests: base and step with the first engine, kept where `talbot formal` keeps them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from talbot.base.jobs import run
from talbot.base.records import from_json
from talbot.verif.formal import manifest
from talbot.verif.formal.plan import pieces
from talbot.verif.formal.proof import Proof
from talbot.verif.formal.prove import ProofResult
from talbot.verif.results import OUT, PROVEN


def failure(proof: Proof, store: Path) -> str:
    """Prove by the first engine; returns '' or the failure. store: folder of the kept results."""
    engine = proof.engines[0]
    job = next(pieces(proof, [engine])).job  # and no twin, whose text a bug may change
    result = from_json(ProofResult, run([job], store, proof.name, workers=1)[0])
    if result.result == PROVEN:
        return ""
    job.file(store).unlink(missing_ok=True)  # tried again next time
    return f"{proof.name} = {result.result} by {engine}: must be proven ({result.cause(proof)})"


class ProofsFile(pytest.File):
    """Proofs of a block: rtl/<block>/formal/proofs.yaml."""

    def collect(self) -> Iterator["ProofItem"]:
        """Yield an item a proof."""
        for proof in manifest.read(self.path):
            yield ProofItem.from_parent(self, name=proof.name, proof=proof)


class ProofItem(pytest.Item):
    """One proof."""

    cls = None  # as of tests outside classes

    def __init__(self, *, proof: Proof, **options: Any) -> None:
        """Mark its tools, and it slow where the proof is, or repeats another at its size."""
        super().__init__(**options)
        self.proof = proof
        self.add_marker(pytest.mark.needs("yosys-smtbmc", proof.engines[0]))
        if proof.slow or proof.size_of:
            self.add_marker("slow")

    def runtest(self) -> None:
        """Prove, or take the kept result."""
        if problem := failure(self.proof, OUT / "formal"):
            pytest.fail(problem, pytrace=False)

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return the place of its declaration; pytest needs a line for a skipped test."""
        return self.path, 0, f"proof {self.name}"
