"""One layout as a point of a sweep: a dict of figures for JSON."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from talbot.base.steps import Runner, Step
from talbot.flow.layout.chain import input_files, timing_steps
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


def _runner(design: Design, options: Options, out: str) -> Runner:
    folder = Path(out) / design.name
    return Runner(folder / "steps", input_files(design, options, folder), shared=Path(out).parent / "shared")
