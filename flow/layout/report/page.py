"""The page of a layout: its picture, the figures against their limits, the steps."""

from pathlib import Path

from jinja2 import Environment, FileSystemLoader

from . import history
from .picture import PALETTE

PLAIN = (
    "design",
    "top",
    "backend",
    "pdk",
    "tried",
    "wall_s",
    "peak_mib",
    "tools",
    "timing_rests_on",
    "table_6_1",
    "not_checked",
)
PARTS = {
    "pixel_array": "pixel array",
    "amplifiers": "amplifiers; here: their control",
    "timing": "timing, addressing",
    "adcs": "converters; here: their logic",
}
BY_CORNER = (
    ("wns_ns", "setup slack, ns"),
    ("whs_ns", "hold slack, ns"),
    ("blocks_wns_ns", "setup slack by the blocks' Liberty, ns"),
    ("blocks_whs_ns", "hold slack by the blocks' Liberty, ns"),
    ("setup_margin_ns", "least seen, setup, ns"),
    ("slews_over", "slews longer than any the cells were measured at"),
    ("worst_slew_ns", "the longest of these, ns"),
    ("hold_margin_ns", "least seen, hold, ns"),
    ("power_uw", "power, uW"),
    ("energy_pj_cycle", "pJ a cycle"),
    ("power_at_chip_clock_uw", "power at 10 MHz, the chip's clock, uW"),
    ("supply_drop_mv", "supply's drop, mV"),
    ("ground_rise_mv", "ground's rise, mV"),
    ("model_error_ns", "block's Liberty off by, ns"),
)


def page(summary, broken, known, runs, picture=None, pictures=()):
    """The report as HTML text. broken: lines of `summary.broken`; known: Embedded; runs: of `history.continued`;
    picture: of the layout, file name beside it; pictures: further (file name, what it shows)."""
    environment = Environment(loader=FileSystemLoader(Path(__file__).parent), autoescape=True)
    key = [(wire.name, f"#{color:06x}") for wire, color in zip(known.wires, PALETTE)]
    return environment.get_template("page.html").render(
        s=summary,
        broken=broken,
        tiles=_tiles(summary, broken),
        figures=_figures(summary),
        picture=picture,
        key=key,
        pictures=pictures,
        corners=_corners(summary),
        blocks=_blocks(summary),
        table=_table(summary),
        history=history.table(runs),
    )


def _tiles(s, broken):
    """What a reader looks for first: dicts value, label, kind ('good', 'bad' or '')."""

    def tile(value, label, rule=None):
        bad = rule and any(line.startswith(rule) for line in broken)
        kind = "bad" if bad else "" if rule is None or value is None else "good"
        return {"value": "-" if value is None else value, "label": label, "kind": kind}

    tests = s["gate_tests"] or {}
    return [
        tile(f"{s['area_um2']:,.0f}", "um2"),
        tile(s["utilization"], "utilization"),
        tile(s["cells"] and f"{s['cells']:,}", "cells"),
        tile(s["open_nets"], "open nets", "open_nets"),
        tile(s["drc_violations"], "rules broken", "drc_violations"),
        tile({True: "match", False: "differ"}.get(s["lvs_match"]), "layout and netlist", "lvs_match"),
        tile(s["equivalence"], "netlist = Verilog", "equivalence"),
        tile(tests.get("passed"), "tests passed on the netlist", "gate_tests"),
        tile(s["f_max_mhz"], "MHz at most"),
        tile(s["antenna_violations"], "antennas", "antenna_violations"),
    ]


def _corners(s):
    """(names of the corners, rows (words, value a corner)) of what is known by corner, or None without timing."""
    corners = list(s.get("wns_ns") or ())
    rows = [(words, [s[name].get(corner) for corner in corners]) for name, words in BY_CORNER if s.get(name)]
    return (corners, rows) if corners else None


def _blocks(s):
    """(block, uW, share) by power, the largest first."""
    found = s.get("power_by_block_uw") or {}
    return [(name, value, value / (sum(found.values()) or 1)) for name, value in found.items()]


def _table(s):
    """(part, uW in Table 6.1, uW here), '-' where there is none."""
    return [
        (PARTS.get(part, part), *("-" if uw is None else f"{uw:,.1f}" for uw in pair))
        for part, pair in (s.get("table_6_1") or {}).items()
    ]


def _figures(s):
    """(name, value as text) of everything that is a figure."""

    def text(value):
        if isinstance(value, dict):
            return ", ".join(f"{name}: {text(v)}" for name, v in value.items())
        if isinstance(value, list):
            return ", ".join(map(str, value)) or "-"
        if isinstance(value, bool):
            return "yes" if value else "no"
        return "-" if value is None else f"{value:,}" if isinstance(value, (int, float)) else str(value)

    return [
        (name, text(value))
        for name, value in s.items()
        if name not in PLAIN and name not in dict(BY_CORNER) and name != "power_by_block_uw"
    ]
