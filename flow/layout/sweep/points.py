"""One layout as a point: a dict of figures for JSON."""

from pathlib import Path

from flow.layout.design import divider
from flow.layout.embedded import Options, files, front, judged, layout, timed, tries
from flow.layout.steps.extraction import Extraction, ExtractionParameters
from flow.layout.steps.place_route import PlaceRoute, PlaceRouteParameters
from flow.steps import Runner

VARIANTS = ("radix2", "radix4", "pipelined", "cordic")
WIDTHS = 4, 8, 12           # fraction bits; CORDIC has none


def candidates():
    """Designs of the divider: every variant, and the dividing ones at every width."""
    return [divider(f"{variant}_{bits}", variant, bits) for variant in VARIANTS
            for bits in (WIDTHS if variant != "cordic" else (8,))]


def variant_point(design, liberty, out, pdk="sky130"):
    """Lay the Design out, in its smallest area that closes, time it and watch it in a frame.

    Returns area, f_max (the slowest corner's), energy a result (the first corner's) and where they come from. Without
    layout against netlist and equivalence: `make layout` of a design has these.
    """
    options = Options(pdk, design.utilization, tuple(map(Path, liberty)))
    runner = _runner(design, options, out)
    tried = layout(design, options, runner, _measured)
    made = {"name": design.name, "variant": design.divider, "bits": design.n_frac, "tries": len(tried),
            "utilization": tried[-1]["utilization"], "closed": tried[-1]["rules_broken"] == 0}
    if not made["closed"]:
        return made
    first, metric = next(iter(options.corners)), {name: record["metrics"] for name, record in runner.records.items()}
    cycles, results = (metric["stimulus"][name] for name in ("cycles", "results"))
    energy = metric[f"power_{first}"]["energy_pj_cycle"]
    return made | {"area_um2": metric["stream_out"]["area_um2"], "cells": metric["synthesis"]["cells"],
                   "f_max_mhz": min(metric[f"sta_{corner}"]["f_max_mhz"] for corner in options.corners),
                   "power_uw": metric[f"power_{first}"]["power_uw"], "results": results, "cycles": cycles,
                   "pj_result": round(energy * cycles / results, 3) if results else None,
                   "right": all(metric[f"gate_delays_{corner}"]["failed"] == 0 for corner in options.corners)}


def _measured(design, options):
    return [Extraction(ExtractionParameters(options.pdk)), *timed(design, options)]


def effort_point(design, liberty, out, effort, variation, utilization, pdk="sky130"):
    """Place and route a design once with an effort of the placer and a variation of density: quality and seconds."""
    options = Options(pdk, utilization, tuple(map(Path, liberty)))
    runner = _runner(design, options, out)
    for step in (*front(design, options), next(tries(design, options))[0]):
        runner.run(step)
    found = runner.run(PlaceRoute(PlaceRouteParameters(pdk, design.clock.port, effort, variation)))
    made = {"effort": effort, "variation": variation, "utilization": utilization,
            "seconds": found["wall_s"],
            "stopped": found["metrics"]["stopped"]}
    if found["metrics"]["stopped"] is not None:
        return made
    mend, *others = judged(design, options)
    wires = runner.run(mend)["metrics"]
    made |= {"open_nets": wires["open_nets"], "wire_um": wires["wire_um"]}
    if wires["open_nets"]:
        return made
    for step in others[:1]:
        runner.run(step)
    runner.run(Extraction(ExtractionParameters(pdk)))
    slack = [runner.run(step)["metrics"]["wns_ns"] for step in timed(design, options) if step.name.startswith("sta_")]
    return made | {"wns_ns": min(slack)}


def _runner(design, options, out):
    folder = Path(out) / design.name
    return Runner(folder / "steps", files(design, options, folder), shared=Path(out).parent / "shared")

