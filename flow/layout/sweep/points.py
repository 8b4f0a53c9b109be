"""One layout as a point of a sweep: a dict of figures for JSON."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from talbot.base.steps import Runner, Step
from talbot.flow.layout.chain import attempts, input_files, routing_steps, synthesis_steps, timing_steps
from talbot.flow.layout.design import Design, divider
from talbot.flow.layout.options import Options
from talbot.flow.layout.search import lay_out_smallest
from talbot.flow.layout.steps.extraction import Extraction
from talbot.flow.layout.steps.parameters import PdkParameters

VARIANTS = ("radix2", "radix4", "pipelined", "cordic")
WIDTHS = 4, 8, 12  # fraction bits; CORDIC has none


def candidates() -> list[Design]:
    """Designs of the divider: every variant, and all but CORDIC at every width."""
    points = [(variant, bits) for variant in VARIANTS for bits in (WIDTHS if variant != "cordic" else (8,))]
    return [divider(f"{variant}_{bits}", variant, bits) for variant, bits in points]


def variant_point(design: Design, liberty: Sequence[str], out: str, pdk: str = "sky130") -> dict[str, Any]:
    """Lay out a design in the smallest area that closes, with timing and power in a frame.

    The point has area, highest clock (of the slowest corner), energy a result (at the first corner) and what they rest
    on. LVS and equivalence are left out: `make layout` runs them.
    """
    options = Options(pdk, design.utilization, tuple(map(Path, liberty)))
    runner = _runner(design, options, out)
    tried = lay_out_smallest(design, options, runner, _signoff)
    made = {"name": design.name, "variant": design.divider, "bits": design.n_frac, "tries": len(tried)}
    made |= {"utilization": tried[-1].utilization, "closed": tried[-1].rules_broken == 0}
    if not made["closed"]:
        return made
    first, metric = next(iter(options.corners)), {name: record["metrics"] for name, record in runner.records.items()}
    cycles, results = (metric["stimulus"][name] for name in ("cycles", "results"))
    energy = metric[f"power_{first}"]["energy_pj_cycle"]
    return made | {
        "area_um2": metric["stream_out"]["area_um2"],
        "cells": metric["synthesis"]["cells"],
        "f_max_mhz": min(metric[f"sta_{corner}"]["f_max_mhz"] for corner in options.corners),
        "power_uw": metric[f"power_{first}"]["power_uw"],
        "results": results,
        "cycles": cycles,
        "pj_result": round(energy * cycles / results, 3) if results else None,
        "right": all(metric[f"gate_delays_{corner}"]["failed"] == 0 for corner in options.corners),
    }


def _signoff(design: Design, options: Options) -> list[Step]:
    return [Extraction(PdkParameters(options.pdk)), *timing_steps(design, options)]


def effort_point(
    design: Design, liberty: Sequence[str], out: str, effort: int, spread: float, utilization: float
) -> dict[str, Any]:
    """Place and route a design once; quality where it closes, and the seconds of place and route.

    effort: of the placer. spread: of what is empty, the share between cells. closed: every net is routed and no rule
    broken.
    """
    options = Options("sky130", utilization, tuple(map(Path, liberty)), effort=effort)
    design = replace(design, spread=spread)
    runner = _runner(design, options, out)
    floorplan, place, arrange = next(attempts(design, options))
    for step in (*synthesis_steps(design, options), floorplan):
        runner.run(step)
    found = runner.run(place)
    made: dict[str, Any] = {"effort": effort, "spread": spread, "utilization": utilization, "closed": False}
    made |= {"seconds": found["wall_s"], "stopped": found["metrics"]["stopped"]}
    if found["metrics"]["stopped"] is not None:
        return made
    repair, route, *others = routing_steps(design, options)
    arranged, _, wires = (runner.run(step) for step in (arrange, repair, route))
    made["seconds"] = round(made["seconds"] + arranged["wall_s"] + wires["wall_s"], 2)
    if wires["metrics"]["open_nets"]:
        return made
    broken = sum(runner.run(step)["metrics"].get(f"{step.name}_violations", 0) for step in others)
    runner.run(Extraction(PdkParameters(options.pdk)))
    sta = [step for step in timing_steps(design, options) if step.name.startswith("sta_")]
    slack = min(runner.run(step)["metrics"]["wns_ns"] for step in sta)
    area = runner.records["stream_out"]["metrics"]["area_um2"]
    return made | {"closed": not broken, "wns_ns": slack, "wire_um": wires["metrics"]["wire_um"], "area_um2": area}


def _runner(design: Design, options: Options, out: str) -> Runner:
    folder = Path(out) / design.name
    return Runner(folder / "steps", input_files(design, options, folder), shared=Path(out).parent / "shared")
