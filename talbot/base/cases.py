"""The page of a table of cases."""

import os
from collections.abc import Sequence
from pathlib import Path

from talbot.base.files import write
from talbot.base.page import TABLES, Section, Tile, render
from talbot.models.stability import Case


def write_page(out: Path, title: str, about: str, cases: Sequence[Case]) -> None:
    """Write report.html into the folder ``out`` and print its path: cases that miss their bound first."""
    missed = [case for case in cases if not case.ok]
    rows = [(case.name, case.bound, case.measured, "ok" if case.ok else "missed") for case in sorted(cases, key=_order)]
    tiles = [Tile(str(len(cases)), "cases"), Tile(str(len(missed)), "bounds missed", "bad" if missed else "good")]
    section = Section(head=("case", "expected", "measured", ""), rows=rows, numbers=False, kind="stack")
    write(out / "report.html", render(TABLES, title, tiles=tiles, about=about, sections=[section]))
    print(f"look at {os.path.relpath(out / 'report.html')}")


def _order(case: Case) -> bool:
    return case.ok
