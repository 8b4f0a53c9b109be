"""Our own cells and a foundry's, design by design: figures of finished layouts, as a table."""

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from talbot.base.files import insert, marked
from talbot.base.paths import RESULTS
from talbot.flow.layout.design import DESIGNS, design
from talbot.flow.openroad.results import broken

FOUNDRY = "quad_divider", "amp_ctrl", "asp_chip"  # designs with a row of the foundry's cells, run or not
HEAD = (
    "design | cells | area, mm2 | instances | f_max at ss, MHz | setup, hold, ns | power at tt, uW | "
    "leakage at tt / ss / ff, uW | wire, mm | seconds | limits broken | utilization"
)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot openroad-compare`."""
    parser.add_argument(
        "designs", nargs="*", default=tuple(DESIGNS), metavar="DESIGN", help="designs that are laid out"
    )
    parser.add_argument("--out", type=Path, default=RESULTS / "layout", help="folder of the layouts")
    parser.add_argument(
        "--document", type=Path, help="also put the table between the marks of this file; rows of layouts not here stay"
    )


def run(options: Namespace) -> int:
    """Print the table of the designs' summaries."""
    before = ""
    if options.document:
        marked(options.document, "cells")  # refused before the work
        before = options.document.read_text(encoding="utf-8")
    text = table([design(name).name for name in options.designs], options.out, before)
    if options.document:
        insert(options.document, "cells", text)
    print(text)
    return 0


def table(names: Sequence[str], out: Path, before: str = "") -> str:
    """Return the table in Markdown, and the designs without a layout below it.

    before: an earlier table, whose rows stay where a layout is not in ``out``.
    """
    columns = HEAD.count("|") + 1
    lines = [f"| {HEAD} |", "|---" * 2 + "|---:" * (columns - 2) + "|"]
    missing: dict[str, list[str]] = {}
    for name in names:
        for library, folder in (("compact", name), ("sky130_fd_sc_hd", f"{name}-openroad")):
            first, path = f"| {name} | {library} |", out / folder / "summary.json"
            if folder != name and name not in FOUNDRY and not path.is_file():
                continue
            earlier = next((line for line in before.splitlines() if line.startswith(first)), None)
            if path.is_file():
                figures = row(json.loads(path.read_text(encoding="utf-8")))
                lines.append(f"{first} {' | '.join(figures)} |")
            elif earlier:
                lines.append(earlier)
            else:
                missing.setdefault(library, []).append(f"`{name}`")
    for library, designs in missing.items():
        lines += ["", f"No layout with `{library}`: {', '.join(designs)}."]
    return "\n".join(lines)


def row(summary: Mapping[str, Any]) -> list[str]:
    """Return the figures of one summary; '' for one that it does not have."""
    slacks = [min(summary[name].values()) if summary[name] else None for name in ("wns_ns", "whs_ns")]
    power = next((uw for corner, uw in (summary["power_uw"] or {}).items() if corner.startswith("tt")), None)
    leakage = " / ".join(f"{uw:,.{0 if uw >= 100 else 2}f}" for uw in (summary.get("leakage_uw") or {}).values())
    figures = ((summary["area_um2"], 1e-6, ".4f"), (summary["cells"], 1, ",d"), (summary["f_max_mhz"], 1, ".1f"))
    more = (summary["wire_um"], 1e-3, ",.1f"), (sum(summary["wall_s"].values()), 1, ",.0f")
    return [
        *(_written(*figure) for figure in figures),
        ", ".join(_written(slack, 1, "+.2f") for slack in slacks),
        _written(power, 1, ",.0f"),
        leakage,
        *(_written(*figure) for figure in more),
        str(len(broken(dict(summary)))),
        _written(summary.get("utilization"), 1, ".2f"),
    ]


def _written(value: float | None, scale: float, form: str) -> str:
    return "" if value is None else format(value if scale == 1 else value * scale, form)
