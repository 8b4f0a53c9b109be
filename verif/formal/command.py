"""Every property proven, every cover point reached, every mutated twin detected: build/verify/formal.json.

The exit status is 1 unless every property is proven by every engine named for it, every cover point of its wrapper is
reached, and every twin fails. A counterexample, an induction that is too weak and a timeout are different results;
--show writes the trace of the first two as a waveform and as a test.
"""

import sys
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from talbot.base.command import failures
from talbot.base.jobs import run as run_jobs
from talbot.base.jobs import worker_count
from talbot.base.records import from_json
from talbot.base.tools import located
from talbot.models.parameters import ParameterError
from talbot.verif.formal import manifest, owners, record, sizes
from talbot.verif.formal.engine import UNDECIDED, version
from talbot.verif.formal.freedom import FreedomResult
from talbot.verif.formal.necessity import ConjunctResult, NecessityResult
from talbot.verif.formal.plan import Piece, pieces
from talbot.verif.formal.proof import Proof
from talbot.verif.formal.prove import CoverResult, ProofResult, TwinResult
from talbot.verif.formal.replay import show
from talbot.verif.results import OUT, PROVEN, BlockResults, Property, write_step


@dataclass(frozen=True)
class Outcome:
    """All results of a proof. engines: by engine. twins: by property. needs, freedom: of its assumptions.

    only_here: conjuncts of its assumptions that they do not have at the first size.
    """

    proof: Proof
    engines: dict[str, ProofResult]
    covers: CoverResult
    twins: dict[str, TwinResult]
    needs: NecessityResult = field(default_factory=NecessityResult)
    freedom: FreedomResult = field(default_factory=FreedomResult)
    only_here: Sequence[str] = ()

    @property
    def properties(self) -> list[Property]:
        """Each property by each engine."""
        proof = self.proof
        if proof.size_of:  # a row for all: the first size lists them
            rows = {proof.name: all(twin.fails for twin in self.twins.values())}
        else:
            rows = {f"{proof.name}.{label}": twin.fails for label, twin in self.twins.items()}
        return [
            Property(
                name,
                f"{engine} ({version(engine)}, {version('yosys')})",
                "unbounded" if proof.method == "induction" else proof.depth,
                result.result,
                fails,
                result.wall_s,
            )
            for name, fails in rows.items()
            for engine, result in self.engines.items()
        ]

    @property
    def problems(self) -> list[str]:
        """Return a line for each property that is not proven, cover point not reached and twin not detected."""
        name = f"{self.proof.block}.{self.proof.name}"
        missing, twins = ([], {}) if self.proof.size_of else (self.covers.missing, self.twins)
        return [
            *(
                f"{name} = {result.result} by {engine}: must be proven ({result.cause(self.proof)})"
                for engine, result in self.engines.items()
                if result.result != PROVEN
            ),
            *(
                f"{name}.{label} = {self.covers.status or 'not reached'}: every cover point must be reached, in "
                f"{self.proof.cover_depth} steps"
                for label in missing
            ),
            *(
                f"{name}.{label} = {twin.status} with its bug in the design: must fail"
                for label, twin in twins.items()
                if not twin.fails
            ),
            *(f"{name}.{conjunct} = needless: the proof must fail without it" for conjunct in self.needs.needless),
            *(f"{name}.{conjunct} = at this size alone: must be at the first" for conjunct in self.only_here),
            *(f"{name}.{conjunct} = timeout: the proof must fail without it" for conjunct in self.needs.undecided),
            *(
                f"{name}: {problem}"
                for problem in (self.freedom.problems(self.proof.never, " ".join(self.proof.tied).split()))
                if self.freedom.reached or self.freedom.status
            ),
        ]


def plan(proofs: Iterable[Proof], every_size: bool = False) -> list[tuple[Proof, list[Piece]]]:
    """Return each of ``proofs`` with its pieces. every_size: check the assumptions at each."""
    first_of = firsts(manifest.every())
    return [
        (proof, [*pieces(proof, present(proof), every_size or first_of[proof.name] == proof.name)]) for proof in proofs
    ]


def collect(planned: Sequence[tuple[Proof, Sequence[Piece]]], store: Path, workers: int = -1) -> list[Outcome]:
    """Run every job of ``planned``.

    store: folder of the kept results. workers: processes, -1 for all cores.
    """
    first_of = firsts(manifest.every())
    results = iter(run_jobs([piece.job for _, parts in planned for piece in parts], store, "formal", workers))
    outcomes, conjuncts = [], {}
    for proof, parts in planned:
        kinds = ProofResult, CoverResult, TwinResult, NecessityResult, FreedomResult, ConjunctResult
        by_kind = {kind: {} for kind in kinds}
        for piece in parts:
            result = from_json(piece.kind, next(results))
            if is_undecided(result):  # tried again next time
                piece.job.file(store).unlink(missing_ok=True)
            by_kind[piece.kind][piece.name] = result
        first = next((outcome for outcome in outcomes if outcome.proof.name == proof.size_of), None)
        needs = by_kind[NecessityResult].get("necessity", NecessityResult())
        conjuncts[proof.name] = [*needs.needed, *needs.needless, *needs.undecided]
        listed = by_kind[ConjunctResult].get("conjuncts", ConjunctResult()).names
        outcomes.append(
            Outcome(
                proof,
                by_kind[ProofResult],
                first.covers if first else by_kind[CoverResult]["cover"],
                first.twins if first else by_kind[TwinResult],
                needs,
                by_kind[FreedomResult].get("freedom", FreedomResult()),
                more(listed, conjuncts.get(first_of[proof.name], listed)),
            )
        )
    return outcomes


def firsts(proofs: Iterable[Proof]) -> dict[str, str]:
    """Return proof -> the first proof of its wrapper, with which the assumptions are checked."""
    by_wrapper: dict[Path, str] = {}
    return {proof.name: by_wrapper.setdefault(proof.wrapper, proof.name) for proof in proofs}


def more(names: Iterable[str], first: Iterable[str]) -> list[str]:
    """Return the conjuncts ``names`` of a size that are not those of the first; several may have one text."""
    return sorted((Counter(names) - Counter(first)).elements())


def is_undecided(result: object) -> bool:
    """Return whether a result of a piece has a timeout."""
    fields = vars(result)
    return any(value in UNDECIDED for value in fields.values()) or bool(fields.get("undecided"))


def present(proof: Proof) -> list[str]:
    """Return the installed engines of a proof; the first is required."""
    return [proof.engines[0], *(engine for engine in proof.engines[1:] if located(engine))]


def summary(outcomes: Sequence[Outcome]) -> dict[str, BlockResults]:
    """Return the proofs and open points by block."""
    results: dict[str, BlockResults] = {}
    for outcome in outcomes:
        entry = results.setdefault(outcome.proof.block, BlockResults())
        entry.proofs += outcome.properties
        entry.open_points += outcome.problems
    return {block: results[block] for block in manifest.BLOCKS if block in results}


def table(outcomes: Iterable[Outcome]) -> str:
    """Return block, property, engine, depth, result, twin and seconds as text."""
    rows = [("block", "property", "engine", "depth", "result", "twin", "s")]
    for outcome in outcomes:
        for p in outcome.properties:
            twin = "fails" if p.twin_fails else "PASSES"
            engine = p.engine.split()[0]
            rows.append((outcome.proof.block, p.name, engine, str(p.depth), p.result, twin, f"{p.wall_s:.1f}"))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def chosen(proofs: Sequence[Proof], options: Namespace) -> list[Proof]:
    """Return the ``proofs`` that the command line names, by default all. Raises ParameterError for none."""
    named = set(options.proof or ())
    if unknown := named - {proof.name for proof in proofs}:
        raise ParameterError(f"proof = {', '.join(sorted(unknown))}: must be the name of a proof")
    named |= {proof.size_of for proof in proofs if proof.name in named}  # whose covers and twins it shares
    selected = [
        proof
        for proof in proofs
        if (not options.only or proof.block in options.only) and (not options.proof or proof.name in named)
    ]
    if not selected:
        raise ParameterError(f"only = {', '.join(options.only or options.proof)}: must be a block with proofs")
    return selected


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot formal`."""
    parser.add_argument(
        "--only", action="append", metavar="BLOCK", choices=manifest.BLOCKS, help="a block (may be repeated)"
    )
    parser.add_argument("--proof", action="append", metavar="NAME", help="a proof by its name (may be repeated)")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of formal.json")
    parser.add_argument(
        "--every-size", action="store_true", help="check the assumptions at every size, not at the first of a wrapper"
    )
    parser.add_argument("--changed", action="store_true", help="leave out what verif/formal/proven.txt has as proven")
    parser.add_argument(
        "--record", action="store_true", help="write verif/formal/proven.txt after a run without problem"
    )
    parser.add_argument(
        "--show", action="store_true", help="write the shortest trace of a --proof that fails: a waveform and a test"
    )
    parser.add_argument("--workers", type=worker_count, default=-1, help="processes; default: all cores")


def shown(options: Namespace, proofs: Sequence[Proof]) -> int:
    """Write and print the trace of each --proof; returns 1 if there is one, else 0.

    Raises ParameterError without --proof, ToolError for a timeout.
    """
    if not options.proof:
        raise ParameterError("show = True: must be with --proof")
    traces = {proof.name: show(proof, options.out / "formal") for proof in proofs if proof.name in options.proof}
    for name, text in traces.items():
        print(text or f"{name} = proven: no trace")
    return int(any(traces.values()))


def run(options: Namespace) -> int:
    """Run the proofs; returns 1 if something is not proven, else 0."""
    every = manifest.every()
    proofs = chosen(every, options)
    if options.show:
        return shown(options, proofs)
    if options.record and (options.changed or options.every_size or len(proofs) < len(every)):
        raise ParameterError("record = True: must be with all proofs, without every-size")
    planned = plan(proofs, options.every_size)
    if options.changed:
        planned = record.unproven(planned)
        print(f"{len(proofs) - len(planned)} of {len(proofs)} proofs are in the record, {record.RECORD.name}")
    outcomes = collect(planned, options.out / "formal", options.workers)
    if not options.changed:
        write_step("formal", summary(outcomes), options.out)
    print(table(outcomes))
    general = [*owners.problems(every, owners.contract()), *sizes.problems(every)]
    for engine in sorted({e for proof in proofs for e in proof.engines} - {"boolector"}):
        if not located(engine):
            print(f"{engine} = not found: second engine skipped; make tools installs it", file=sys.stderr)
    problems = [*general, *(line for outcome in outcomes for line in outcome.problems)]
    if options.record and not problems:
        record.keep(record.digests(planned))
    return failures(problems)
