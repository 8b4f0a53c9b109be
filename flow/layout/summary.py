"""What a layout came to: summary.json, and the limits of rules.json that it must keep."""

import json
from pathlib import Path

RULES = json.loads((Path(__file__).parent / "rules.json").read_text())


def summarize(design, options, runner, tried):
    """The contract of summary.json, as a dict; what was not run is None."""
    records = runner.records

    def metric(step, name):
        return records[step]["metrics"].get(name) if step in records else None

    def by_corner(name):
        return {corner: metric(f"sta_{corner}", name) for corner in options.corners
                if f"sta_{corner}" in records} or None

    area = metric("floorplan", "core_area_um2")
    tools = {}
    for record in records.values():
        tools |= record["tools"]
    return {
        "design": design.name, "top": design.top, "backend": "coriolis", "pdk": options.pdk,
        "cells": metric("synthesis", "cells"), "flip_flops": metric("synthesis", "flip_flops"),
        "cell_area_um2": metric("synthesis", "cell_area_um2"), "area_um2": metric("stream_out", "area_um2") or area,
        "utilization": tried[-1]["utilization"], "tried": tried,
        "wire_um": metric("mend", "wire_um"), "open_nets": metric("mend", "open_nets"),
        "mended": metric("mend", "mended"), "hopped": metric("mend", "hopped"),
        "clock_buffers": metric("place_route", "clock_buffers"),
        "drc_violations": metric("drc", "drc_violations"), "lvs_match": metric("lvs", "lvs_match"),
        "antenna_violations": metric("antenna", "antenna_violations"), "density": metric("antenna", "density"),
        "equivalence": metric("equivalence", "equivalence"),
        "timing_rests_on": timing(options), **{name: by_corner(name) for name in ("wns_ns", "whs_ns")},
        "f_max_mhz": min((by_corner("f_max_mhz") or {"": None}).values()), "power_uw": by_corner("power_uw"),
        "wire_pf": metric("extraction", "wire_pf"),
        "registers": metric("equivalence", "registers"),
        "gate_tests": next((records[name]["metrics"] for name in ("gate_tests", "gate_frames")
                            if name in records), None),
        "wall_s": {name: record["wall_s"] for name, record in records.items()},
        "peak_mib": {name: record["peak_mib"] for name, record in records.items()},
        "tools": dict(sorted(tools.items()))}


def timing(options):
    """What the timing figures rest on, in words."""
    if not options.corners:
        return "no timing: cells by area alone"
    cells = ", ".join(path.name for path in options.liberty) or f"measured at {', '.join(options.corners)}"
    return (f"cells: {cells}; wires: area and edge capacitance to the substrate and resistance from the router's "
            "wires, no coupling; power: OpenSTA's default activity, not a simulation's")


def broken(summary, rules=RULES):
    """Rules that ``summary`` breaks: list of 'name = value: must be ...'.

    rules: dict name -> {"is": value} or {"most": number} or {"least": number}, a dot in a name for a dict in the
    summary; every value of a dict must keep the rule. What was not measured breaks it, but with "if_measured".
    """
    found = []
    for name, rule in rules.items():
        value = summary
        for part in name.split("."):
            value = value.get(part) if isinstance(value, dict) else None
        if value is None and rule.get("if_measured"):
            continue
        if not all(_keeps(one, rule) for one in (value.values() if isinstance(value, dict) else [value])):
            wanted = " and ".join(f"{'at ' if word != 'is' else ''}{word} {rule[word]}".removeprefix("is ")
                                  for word in ("is", "least", "most") if word in rule)
            found.append(f"{name} = {value}: must be {wanted}")
    return found


def _keeps(value, rule):
    return (value is not None and ("is" not in rule or value == rule["is"])
            and ("most" not in rule or value <= rule["most"]) and ("least" not in rule or value >= rule["least"]))
