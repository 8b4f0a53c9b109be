"""One summary by block from the results of all steps, and the figures that limits are set for."""

from collections.abc import Iterable, Mapping

from talbot.rtl.tops import TOPS
from talbot.verif.results import COVERAGE, PROVEN, BlockResults
from talbot.verif.suite.blocks import BLOCKS

MUTANTS = "made", "equivalent", "killed", "survived"


def summarize(steps: Iterable[Mapping[str, BlockResults]]) -> dict[str, BlockResults]:
    """Return the sum of the results of all steps by block; a block without results is empty."""
    summary = {block: BlockResults() for block in BLOCKS}
    for by_block in steps:
        for block, entry in by_block.items():
            summary.setdefault(block, BlockResults()).add(entry)
    return summary


def figures(entry: BlockResults) -> dict[str, float | None]:
    """Return the figures of a block that limits are set for, None where nothing was measured."""
    proofs, mutants = entry.proofs, entry.mutants
    values = {
        "tests.passed": entry.tests.passed,
        "tests.failed": entry.tests.failed,
        "proofs.proven": sum(p.good for p in proofs),
        "proofs.unproven": sum(p.result != PROVEN for p in proofs),
        "proofs.twins_not_caught": sum(not p.twin_fails for p in proofs),
        **{f"coverage.{kind}": entry.coverage.get(kind) for kind in COVERAGE},
        **{f"mutants.{kind}": mutants and getattr(mutants, kind) for kind in MUTANTS},
        "mutants.score": mutants and mutants.score,
        "stuck_at.share": entry.stuck_at and entry.stuck_at.share,
        "open_points": len(entry.open_points),
    }
    if entry.fuzz and "cycles" in entry.fuzz.kinds:
        values["fuzz.cycles"] = entry.fuzz.kinds["cycles"]
    for name, part in (("fuzz", entry.fuzz), ("resync", entry.resync)):
        if part:
            values |= {f"{name}.{key}": value for key, value in vars(part).items() if isinstance(value, int)}
    return values


def totals(summary: Mapping[str, BlockResults]) -> dict[str, float]:
    """Return the sums over all blocks of the figures that are counts."""
    sums: dict[str, float] = {}
    for entry in summary.values():
        for name, value in figures(entry).items():
            if isinstance(value, int) and not name.startswith("coverage"):
                sums[name] = sums.get(name, 0) + value
    return sums


def is_rtl(block: str) -> bool:
    """Return whether a block is a top of rtl.tops."""
    return block in TOPS
