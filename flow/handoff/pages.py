"""The pages for people: pinout and datasheet, in Markdown."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from talbot.base.lef.read import read_macro
from talbot.base.table import markdown_table
from talbot.flow.layout.design import Design

WATCHED = {"frame": "a real frame", "tests": "the block's own tests", "host": "an example behind its host"}


def pinout(lef: str) -> str:
    """Markdown table of the pins of a LEF."""
    pins = read_macro(lef).pins.values()
    rows = ((p.name, p.direction.lower(), p.use.lower(), p.layer, p.x_um, p.y_um) for p in pins)
    return f"# Pinout\n\n{markdown_table(('pin', 'direction', 'use', 'layer', 'x um', 'y um'), rows, 4)}\n"


def datasheet(design: Design, summary: Mapping[str, Any], lef: str, waivers: Sequence[Mapping[str, str]]) -> str:
    """Return a page: size, timing by corner, power, checks, waivers. A figure that was not measured is a dash."""
    macro = read_macro(lef)
    io, clock = design.io, design.clock
    tests, density, stimulus = summary.get("gate_tests"), summary.get("density") or {}, summary.get("stimulus")
    watched = f"{summary.get('stimulus_cycles')} cycles of {WATCHED[stimulus]}" if stimulus else None
    rows = [
        ("top", design.top),
        ("process", summary.get("pdk")),
        ("size", f"{macro.width_um:g} x {macro.height_um:g} um"),
        ("cells", summary.get("cells")),
        ("flip-flops", summary.get("flip_flops")),
        ("clock", f"{clock.port}, {1000 / clock.period_ns:g} MHz"),
        *_figures(summary, "f_max_mhz", "highest clock, MHz"),
        *_figures(summary, "power_uw", "power, uW"),
        ("input delay, output delay", f"{io.input_delay:.0%}, {io.output_delay:.0%} of the period"),
        ("load of an output", f"{io.load_pf:g} pF"),
        *_figures(summary, "wns_ns", "setup slack, ns"),
        *_figures(summary, "whs_ns", "hold slack, ns"),
        ("timing rests on", summary.get("timing_rests_on")),
        ("power rests on", watched),
        *_figures(summary, "energy_pj_cycle", "energy a cycle, pJ"),
        *_figures(summary, "ir_drop_percent", "largest voltage drop, % of the supply"),
        ("netlist's tests passed, failed", tests and f"{tests['passed']}, {tests['failed']}"),
        ("metal by layer", ", ".join(f"{name} {share:.0%}" for name, share in density.items()) or None),
        ("DRC violations", summary.get("drc_violations")),
        ("layout = netlist", summary.get("lvs_match")),
        ("netlist = RTL", summary.get("equivalence")),
        ("antenna violations", summary.get("antenna_violations")),
        ("open nets", summary.get("open_nets")),
    ]
    table = [f"| {name} | {'-' if value is None else value} |" for name, value in rows]
    waived = [f"- {w['rule']}: {w['reason']}" for w in waivers] or ["None."]
    return "\n".join([f"# {design.name}", "", "| | |", "|---|---|", *table, "", "## Waivers", "", *waived, ""])


def _figures(summary: Mapping[str, Any], name: str, words: str) -> Iterator[tuple[str, Any]]:
    """Rows of a figure that summary.json holds by corner, as one number, or not at all."""
    value = summary.get(name)
    for corner, figure in value.items() if isinstance(value, dict) else [("", value)]:
        yield f"{words}{f' ({corner})' if corner else ''}", figure
