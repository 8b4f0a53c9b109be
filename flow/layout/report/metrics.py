"""Figures of a layout: summary.json, and the limits of rules.json that it must keep."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from talbot.base.steps import Runner
from talbot.flow.layout.design import Design
from talbot.flow.layout.options import Options
from talbot.models.parameters import ChipParameters, EnergyParameters

BOUNDS = {"is": "", "least": "at least", "most": "at most"}  # of a rule, as words
# Parts of the power in [Jayasuriya2017, Table 6.1] and the blocks of AspChip that do their digital work; pixels,
# amplifiers and the converters' comparators are analog. What the sensor of Table 6.1 did not have is in none of them
TABLE_6_1 = {"pixel_array": (), "amplifiers": ("amp",), "timing": ("seq", "regs", "balancer"), "adcs": ("bank",)}
CHECKS = "foundry_drc", "magic_drc", "antenna"
RULES = json.loads((Path(__file__).parent / "rules.json").read_text(encoding="utf-8"))


@dataclass
class Attempt:
    """One floorplan with its placement and routing.

    asked: area of the synthesized cells by that of the core. aspect: width by height. utilization: the same of all
    cells of the layout. open_nets: after routing. rules_broken: of design and antennas; None without a layout. stopped:
    why there is no layout. again: stages that ran twice, and why.
    """

    asked: float
    aspect: float
    utilization: float | None = None
    open_nets: int | None = None
    rules_broken: int | None = None
    stopped: str | None = None
    again: list[str] = field(default_factory=list)


def summarize(design: Design, options: Options, runner: Runner, attempts: Sequence[Attempt]) -> dict[str, Any]:
    """Content of summary.json; what was not run is None."""
    records = runner.records

    def metric(step: str, name: str) -> Any:
        return records[step]["metrics"].get(name) if step in records else None

    def own(step: str, *names: str) -> dict[str, Any]:
        return {name: metric(step, name) for name in names}

    def by_corner(name: str, step: str = "sta") -> dict[str, Any] | None:
        found = {corner: f"{step}_{corner}" for corner in options.corners}
        return {corner: metric(one, name) for corner, one in found.items() if one in records} or None

    first = next(iter(options.corners), "")
    slowed = ChipParameters().f_clk * design.clock.period_ns * 1e-9  # factor to the chip's clock
    tools = {}
    for record in records.values():
        tools |= record["tools"]
    return {
        "design": design.name,
        "top": design.top,
        "user_verilog": bool(design.verilog),
        "backend": "openroad",
        "pdk": options.pdk,
        **own("stream_out", "cells", "cell_area_um2"),
        **own("synthesis", "flip_flops"),
        **own("stream_out", "area_um2"),
        "utilization": attempts[-1].utilization,
        "attempts": [asdict(attempt) for attempt in attempts],
        **own("stream_out", "wire_um", "vias"),
        **own("finish", "open_nets"),
        **own("mend", "router_drc_violations", "router_antennas"),
        **own("stream_out", "diodes", "clock_buffers"),
        "clock_gates": metric("synthesis", "clock_gates"),
        "drc_violations": metric("drc", "drc_violations"),
        "lvs_match": metric("lvs", "lvs_match"),
        **{f"{step}_violations": metric(step, f"{step}_violations") for step in CHECKS},
        "density": metric("fill", "density"),
        "density_violations": metric("fill", "density_violations"),
        "thin_layers": metric("fill", "thin_layers"),
        "fill_shapes": metric("fill", "shapes"),
        "equivalence": metric("equivalence", "equivalence"),
        "timing_rests_on": timing_basis(options),
        **{name: by_corner(name) for name in ("wns_ns", "whs_ns", "hold_by_wires_ns")},
        **{name: by_corner(name) for name in ("slew_violations", "capacitance_violations")},
        "f_max_mhz": min((by_corner("f_max_mhz") or {"": None}).values()),
        **{name: by_corner(name, "power") for name in ("power_uw", "energy_pj_cycle")},
        "leakage_uw": metric("leakage", "leakage_uw"),
        "power_at_chip_clock_uw": at_chip_clock(by_corner("energy_pj_cycle", "power")),
        "table_6_1": table_6_1(metric(f"power_{first}", "by_block"), slowed) if design.is_chip else None,
        "power_by_block_uw": metric(f"power_{first}", "by_block"),
        "power_by_kind_uw": metric(f"power_{first}", "by_kind"),
        **{name: by_corner(name, "ir_drop") for name in ("supply_drop_mv", "ground_rise_mv", "ir_drop_percent")},
        "stimulus": metric("stimulus", "source"),
        "stimulus_cycles": metric("stimulus", "cycles"),
        **{name: by_corner(name, "gate_delays") for name in ("setup_margin_ns", "hold_margin_ns")},
        "model_error_ns": by_corner("model_error_ns", "block_liberty"),
        "wire_pf": metric("extraction", "wire_pf"),
        "registers": metric("equivalence", "registers"),
        "gate_tests": gate_tests(records),
        **{key: {name: record[key] for name, record in records.items()} for key in ("wall_s", "peak_mib")},
        "tools": dict(sorted(tools.items())),
    }


def at_chip_clock(energies: dict[str, float] | None) -> dict[str, float] | None:
    """Power (uW) by corner at the clock of the thesis's chip, from pJ a cycle; output loads are left out."""
    return energies and {corner: round(pj * ChipParameters().f_clk / 1e6, 3) for corner, pj in energies.items()}


def table_6_1(by_block: dict[str, float] | None, slowed: float) -> dict[str, list[float | None]] | None:
    """Map each part to [uW in the thesis, uW here]; None without power. Parts of Table 6.1 are first.

    by_block: uW. slowed: factor to the clock of the thesis's chip.
    """
    if by_block is None:
        return None
    found: dict[str, list[float | None]] = {}
    for part, blocks in TABLE_6_1.items():
        own = round(slowed * sum(by_block.get(block, 0.0) for block in blocks), 3) if blocks else None
        found[part] = [round(getattr(EnergyParameters(), part) * 1e6, 3), own]
    counted = {block for blocks in TABLE_6_1.values() for block in blocks}
    return found | {block: [None, round(slowed * uw, 3)] for block, uw in by_block.items() if block not in counted}


def gate_tests(records: Mapping[str, dict[str, Any]]) -> dict[str, Any] | None:
    """Tests passed and failed in all netlist simulations, then in each of them; None without one."""
    kinds, metrics = ("passed", "failed"), {name: record["metrics"] for name, record in records.items()}
    runs = {name: {kind: found[kind] for kind in kinds} for name, found in metrics.items() if name.startswith("gate_")}
    return {kind: sum(run[kind] for run in runs.values()) for kind in kinds} | runs if runs else None


def timing_basis(options: Options) -> str:
    """What the timing figures rest on."""
    cells = ", ".join(path.name for path in options.liberty) or f"measured at {', '.join(options.corners)}"
    return (
        f"cells: {cells}; parasitics: of the finished layout, with coupling (as to ground) and fill, every net a tree "
        "of resistors, wires at the corner that goes with the cells'; power: transitions of the netlist in its trace"
    )


def broken(summary: dict[str, Any], rules: Mapping[str, dict[str, Any]] = RULES) -> list[str]:
    """Rules that ``summary`` breaks, a line 'name = value: must be ...' each.

    rules: name -> {"is": value}, {"most": number} or {"least": number}; a dot in a name leads into a dict of the
    summary. Every value of a dict must keep the rule; a figure that was not measured breaks it unless "if_measured".
    "unless": a figure of the summary that spares a design the rule where it is true.
    """
    found = []
    for name, rule in rules.items():
        value: Any = summary
        for part in name.split("."):
            value = value.get(part) if isinstance(value, dict) else None
        if (value is None and rule.get("if_measured")) or summary.get(rule.get("unless", "")):
            continue
        if not all(_keeps(one, rule) for one in (value.values() if isinstance(value, dict) else [value])):
            wanted = [f"{word} {rule[key]}".lstrip() for key, word in BOUNDS.items() if key in rule]
            found.append(f"{name} = {value}: must be {' and '.join(wanted)}")
    return found


def _keeps(value: Any, rule: Mapping[str, Any]) -> bool:
    return (
        value is not None
        and ("is" not in rule or value == rule["is"])
        and ("most" not in rule or value <= rule["most"])
        and ("least" not in rule or value >= rule["least"])
    )
