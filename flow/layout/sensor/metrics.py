"""Figures of the die: summary.json, and the limits that it must keep."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from talbot.base.steps import Runner
from talbot.flow.layout.options import Options
from talbot.flow.layout.report.metrics import timing_basis
from talbot.flow.layout.sensor.package import packaged
from talbot.flow.layout.sensor.plan import BLOCKS
from talbot.flow.layout.sensor.steps.die_sta import DieSta

RULES = json.loads((Path(__file__).parent / "rules.json").read_text(encoding="utf-8"))
ROUTED = "nets", "routed", "abutted", "tracks", "wire_um", "pads", "decoupling_pf"
CHECKED = "open_nets", "shorts", "drc_violations", "lvs_match", "antenna_violations"
DROPS = "pixel_drop_mv", "pixel_spread_mv", "pixel_drop_both_mv"  # of a drawn array
PADS = "pad_drc_violations", "pads_unmatched"
LOADS = "wire_pf", "worst_load_pf", "worst_load", "worst_delay_ns", "worst_delay", "loads_over"
SLACKS = [name for name in DieSta.metrics if name != "f_max_mhz"]  # by corner
PADS_ONLY = "pads: rules and LVS of each cell; ESD without resistance of wires and without parasitic bipolars"
ESD = "esd_clamps", "esd_core_clamps", "esd_pad_v", "esd_core_v"
QUIET = "core_leak_ua", "core_rise_ua", "core_ripple_ua"
WRAPPED = "the wrapper's pads without a driver have no ESD clamp; fill and seal ring are the shuttle's"
SHOWN = 12  # nets in the summary, those with the largest loads
BOXES_NOT_CHECKED = "insides of the black boxes: outlines with pins, no circuit; they have no rule, netlist or current"
NOT_CHECKED = (
    "pixels of the drawn array: rules and LVS of make pixel-layout, of a small array of the same cells",
    "density of diffusion and poly outside of the blocks",
    "antennas on the highest metal of the channel: whether a net's driver has the diffusion for it",
    "coupling of the die's nets to blocks and bars; nets to the abutting rows, columns and lanes have no length here",
    "IR drop of other supplies than the drawn array's",
    "hold at the analog blocks, and their setup: the constraints leave them a share of the period",
)


def summarize(name: str, options: Options, runner: Runner, black_boxes: Sequence[str]) -> dict[str, Any]:
    """Content of summary.json; what a die does not have is None."""
    records = runner.records
    sta = {corner: records[f"die_sta_{corner}"]["metrics"] for corner in options.corners}
    metrics, tools = {}, {}
    for record in records.values():
        metrics |= record["metrics"]
        tools |= record["tools"]
    plan = json.loads(runner.paths["die_plan.plan"].read_text(encoding="utf-8"))
    nets = json.loads(runner.paths["die_parasitics.nets"].read_text(encoding="utf-8"))
    loads = {net: found["load_pf"] for net, found in nets.items()}
    wrapped = not plan["ring"]
    package, bonded = (None, []) if wrapped else packaged(plan)
    return {
        "design": name,
        "top": name,
        "backend": "channel",
        "pdk": options.pdk,
        "cells": None,
        **{key: metrics[key] for key in ("area_um2", "utilization")},
        "attempts": [],
        "blocks": {block: placed(found) for block, found in plan["blocks"].items()},
        "black_boxes": list(black_boxes),
        "circuits": [block for block in BLOCKS if block not in black_boxes],
        **{key: metrics[key] for key in ROUTED + CHECKED + LOADS},
        **{key: metrics.get(key) for key in (*PADS, *ESD, *QUIET)},
        "wrapper": plan["cell"] if wrapped else None,
        "leads": package.leads if package else None,
        "lead_pitch_mm": package.pitch_mm if package else None,
        "bond_wire_mm": round(max(lead.wire_mm for lead in bonded), 2) if bonded else None,
        **dict.fromkeys(("equivalence", "gate_tests", "power_uw")),
        "timing_rests_on": f"the chip, its ports with the die's nets{extrapolated(sta)}; {timing_basis(options)}",
        **{key: {corner: found[key] for corner, found in sta.items()} or None for key in SLACKS},
        "f_max_mhz": min((found["f_max_mhz"] for found in sta.values()), default=None),
        **{key: metrics.get(key) for key in ("foundry_drc_violations", "outside_density", *DROPS)},
        "largest_loads": dict(sorted(loads.items(), key=lambda item: -item[1])[:SHOWN]),
        "not_checked": [*([BOXES_NOT_CHECKED] if black_boxes else []), *NOT_CHECKED, WRAPPED if wrapped else PADS_ONLY],
        **{name: {step: record[name] for step, record in records.items()} for name in ("wall_s", "peak_mib")},
        "tools": dict(sorted(tools.items())),
    }


def extrapolated(sta: Mapping[str, Mapping[str, Any]]) -> str:
    """Note on slacks with slews beyond the cells' tables. sta: metrics by corner."""
    over = any(found["slews_over"] for found in sta.values())
    return ", delays EXTRAPOLATED where slews are beyond the cells' tables (slews_over)" if over else ""


def placed(block: Mapping[str, Any]) -> str:
    """'cell, width x height at (x, y), orientation' of a block of the plan, um; orientations of LEF."""
    left, bottom, right, top = (size / 1000 for size in block["box"])
    return f"{block['cell']}, {right - left:g} x {top - bottom:g} at ({left:g}, {bottom:g}), {block['orientation']}"
