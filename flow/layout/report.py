"""The page of a layout: its picture, the figures against their limits, the steps."""

from pathlib import Path

from jinja2 import Environment, FileSystemLoader

from .picture import PALETTE

PLAIN = ("design", "top", "backend", "pdk", "tried", "wall_s", "peak_mib", "tools", "timing_rests_on")


def page(summary, broken, known, picture=None):
    """The report as HTML text. broken: lines of `summary.broken`; known: Embedded; picture: file name beside it."""
    environment = Environment(loader=FileSystemLoader(Path(__file__).parent), autoescape=True)
    key = [(wire.name, f"#{color:06x}") for wire, color in zip(known.wires, PALETTE)]
    return environment.get_template("report.html").render(
        s=summary, broken=broken, tiles=_tiles(summary, broken), figures=_figures(summary), picture=picture, key=key)


def _tiles(s, broken):
    """What a reader looks for first: dicts value, label, kind ('good', 'bad' or '')."""
    def tile(value, label, rule=None):
        kind = "" if rule is None else "bad" if any(line.startswith(rule) for line in broken) else "good"
        return {"value": "-" if value is None else value, "label": label, "kind": kind}

    tests = s["gate_tests"] or {}
    return [tile(f"{s['area_um2']:,.0f}", "um2"), tile(s["utilization"], "utilization"),
            tile(f"{s['cells']:,}", "cells"),
            tile(s["open_nets"], "open nets", "open_nets"), tile(s["drc_violations"], "rules broken", "drc_violations"),
            tile({True: "match", False: "differ"}.get(s["lvs_match"]), "layout and netlist", "lvs_match"),
            tile(s["equivalence"], "netlist = Verilog", "equivalence"),
            tile(tests.get("passed"), "tests passed on the netlist", "gate_tests"),
            tile(s["f_max_mhz"], "MHz at most"), tile(s["antenna_violations"], "antennas", "antenna_violations")]


def _figures(s):
    """(name, value as text) of everything that is a figure."""
    def text(value):
        if isinstance(value, dict):
            return ", ".join(f"{name}: {text(v)}" for name, v in value.items())
        if isinstance(value, bool):
            return "yes" if value else "no"
        return "-" if value is None else f"{value:,}" if isinstance(value, (int, float)) else str(value)
    return [(name, text(value)) for name, value in s.items() if name not in PLAIN]
