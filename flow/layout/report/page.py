"""The report of a layout: summary.json, history.jsonl and report.html with picture, figures against limits, steps."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from PIL import Image

from talbot.base.page import Picture, Tile, render
from talbot.flow.layout.report.history import history, table
from talbot.flow.layout.report.picture import LayoutPicture
from talbot.flow.layout.report.text import as_text

NOT_FIGURES = {"design", "top", "backend", "pdk", "attempts", "wall_s", "peak_mib", "tools", "timing_rests_on"}
NOT_FIGURES |= {"table_6_1", "not_checked", "power_by_block_uw"}
ACRONYMS = "drc", "lvs"
UNITS = {"um2": "um2", "um": "um", "pf": "pF", "uw": "uW", "mhz": "MHz", "ns": "ns", "percent": "%", "mv": "mV"}
PARTS = {"pixel_array": "pixel array", "amplifiers": "amplifiers; here: their control"}
PARTS |= {"timing": "timing, addressing", "adcs": "converters; here: their logic"}
BY_CORNER = (
    ("wns_ns", "setup slack, ns"),
    ("whs_ns", "hold slack, ns"),
    ("hold_by_wires_ns", "hold slack by corner of the wires, ns"),
    ("setup_margin_ns", "least simulated setup margin, ns"),
    ("slews_over", "slews beyond the cells' tables"),
    ("worst_slew_ns", "the longest of these, ns"),
    ("hold_margin_ns", "least simulated hold margin, ns"),
    ("power_uw", "power, uW"),
    ("leakage_uw", "leakage, uW"),
    ("energy_pj_cycle", "energy a cycle, pJ"),
    ("power_at_chip_clock_uw", "power at the chip's clock, 10 MHz, uW"),
    ("supply_drop_mv", "IR drop, supply, mV"),
    ("ground_rise_mv", "IR drop, ground, mV"),
    ("model_error_ns", "error of the block's Liberty, ns"),
)


def picture(path: Path, caption: str) -> Picture:
    """A picture in a file, for the page."""
    with Image.open(path) as image:
        return Picture(path.stem, "", caption, image.convert("RGB"))


def write_report(
    part: Path,
    folder: Path,
    summary: dict[str, Any],
    broken: Sequence[str],
    layout: LayoutPicture | None = None,
    pictures: Sequence[Picture] = (),
) -> None:
    """Write summary, history and page into ``part``, whose files will be in ``folder``.

    broken: lines of `metrics.broken`. pictures: beside that of the layout.
    """
    runs = history(folder / "history.jsonl", summary)
    (part / "history.jsonl").write_text("".join(run.line() for run in runs), encoding="utf-8")
    (part / "summary.json").write_text(json.dumps(summary, indent=1) + "\n", encoding="utf-8")
    shown = {"layout": layout, "pictures": pictures, "history": table(runs)}
    tables = {"corners": _corners(summary), "blocks": _blocks(summary), "table": _table(summary)}
    tables |= {"tiles": tiles(summary, broken), "figures": _figures(summary), "attempts": _attempts(summary)}
    tables["steps"] = [(step, f"{s:,.1f}", f"{summary['peak_mib'][step]:,}") for step, s in summary["wall_s"].items()]
    page = render(
        Path(__file__).with_name("page.html"),
        f"{summary['design']}: layout of {summary['top']}",
        picture=layout and layout.image,
        s=summary,
        broken=broken,
        **tables,
        **shown,
    )
    (part / "report.html").write_text(page, encoding="utf-8")


def closing(summary: dict[str, Any], broken: Sequence[str], report: Path) -> str:
    """What a reader looks for first, as a table for a terminal; of what was not run it says so.

    broken: lines of `metrics.broken`. report: the page.
    """
    rows = [(tile.label, tile.value) for tile in tiles(summary, broken)]
    rows += [("limits", f"{len(broken)} broken" if broken else "all kept"), ("look at", str(report))]
    return "\n".join(f"  {label:<28}{value}" for label, value in rows)


def tiles(s: dict[str, Any], broken: Sequence[str]) -> list[Tile]:
    """What a reader looks for first; broken: lines of `metrics.broken`."""

    def tile(value: Any, label: str, rule: str | None = None) -> Tile:
        bad = rule and any(line.startswith(rule) for line in broken)
        if value is None:
            return Tile("not run", label, "bad" if bad else "none")
        return Tile(str(value), label, "bad" if bad else "good" if rule else "")

    def worst(name: str, label: str, rule: str = "", unit: str = "ns", sign: int = 1) -> Tile:
        by_corner = s.get(name) or {}
        corner = min(by_corner, key=lambda corner: sign * by_corner[corner], default=None)
        if corner is None:
            return tile(None, label, rule)
        return tile(f"{by_corner[corner]:,.{3 if unit == 'ns' else 1}f} {unit}", f"{label}, {corner}", rule)

    tests = s["gate_tests"] or {}
    return [
        tile(s["area_um2"] and f"{s['area_um2']:,.0f} um2", "area"),
        tile(s["utilization"] and f"{100 * s['utilization']:.0f} %", "utilization"),
        tile(s["cells"] and f"{s['cells']:,}", "cells"),
        tile(s["open_nets"], "open nets", "open_nets"),
        tile(s["drc_violations"], "DRC violations", "drc_violations"),
        tile({True: "match", False: "differ"}.get(s["lvs_match"]), "LVS", "lvs_match"),
        tile(s["equivalence"], "equivalence", "equivalence"),
        tile(tests.get("passed"), "netlist tests passed", "gate_tests"),
        worst("wns_ns", "setup slack", "wns_ns"),
        worst("whs_ns", "hold slack", "whs_ns"),
        worst("leakage_uw", "leakage", unit="uW", sign=-1),
        tile(s["f_max_mhz"] and f"{s['f_max_mhz']:.1f} MHz", "highest clock"),
        tile(s["antenna_violations"], "antennas", "antenna_violations"),
    ]


def _corners(s: dict[str, Any]) -> tuple[list[str], list[list[str | None]]] | None:
    """Names of the corners and rows (label, value a corner) of the figures by corner; None without timing."""
    corners: list[str] = list(s.get("wns_ns") or ())
    rows = [[words, *(_text(s[name].get(corner)) for corner in corners)] for name, words in BY_CORNER if s.get(name)]
    return (corners, rows) if corners else None


def _attempts(s: dict[str, Any]) -> list[list[str | None]]:
    """Rows of the search for the smallest area."""
    names = "asked", "aspect", "utilization", "open_nets", "rules_broken", "stopped", "again"
    return [[_text(attempt[name]) for name in names] for attempt in s.get("attempts") or ()]


def _blocks(s: dict[str, Any]) -> list[tuple[str, float, float]]:
    """Rows (block, uW, share), the largest power first."""
    found = s.get("power_by_block_uw") or {}
    return [(name, value, value / (sum(found.values()) or 1)) for name, value in found.items()]


def _table(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows (part, uW in Table 6.1, uW here), '-' for none."""
    return [
        (PARTS.get(part) or part, *("-" if uw is None else f"{uw:,.1f}" for uw in pair))
        for part, pair in (s.get("table_6_1") or {}).items()
    ]


def _figures(s: dict[str, Any]) -> list[tuple[str, str | None]]:
    """Rows (name, value as text, None for what was not run) of the figures without a table of their own."""
    left = NOT_FIGURES | dict(BY_CORNER).keys()
    return [(_name(name), _text(value)) for name, value in s.items() if name not in left]


def _name(name: str) -> str:
    """A name of summary.json in words: area_um2 is 'area, um2'."""
    words = [word.upper() if word in ACRONYMS else word for word in name.split("_")]
    unit = UNITS.get(words[-1])
    return f"{' '.join(words[:-1])}, {unit}" if unit else " ".join(words)


def _text(value: Any) -> str | None:
    if value is None:
        return None
    if isinstance(value, dict):
        return ", ".join(f"{name.replace('_', ' ')}: {_text(v)}" for name, v in value.items())
    return ", ".join(map(str, value)) or "none" if isinstance(value, list) else as_text(value)
