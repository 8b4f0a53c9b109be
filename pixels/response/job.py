"""Search, curves, errors, other heights -> response.npz, tile.gds, page, pictures, summary.json."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from talbot.base.files import check_folder, staged
from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.base.records import from_json
from talbot.models.parameters import OpticsParameters, PixelType, SensorParameters
from talbot.pixels.optics.design import Design
from talbot.pixels.optics.solve import Floats
from talbot.pixels.response.drawn import write_tile
from talbot.pixels.response.errors import Kept, errors
from talbot.pixels.response.search import Plan, search
from talbot.pixels.response.types import (
    Measured,
    at_heights,
    axes_of,
    measured,
    name_of,
    nearest,
    solve_around,
    solve_one,
    stacked,
    wavelengths_of,
)
from talbot.platforms.optics import OpticalStack, tables

STEPS = "candidates", "refine", "curves", "report"
STORE = BUILD / "pixel" / "solved"


def make(
    stack: OpticalStack,
    kinds: Sequence[str],
    sensor: SensorParameters,
    out: Path,
    note: Callable[[str], None] = lambda text: None,
) -> dict[str, Any]:
    """Find the pixels of ``stack`` for ``sensor``, write all about them into ``out``; returns the summary.

    Raises ParameterError.
    """
    from talbot.pixels.response import page  # Matplotlib: not before it is needed

    start = perf_counter()
    check_folder("out", out, page.NAMES)
    types, pitch_um = sensor.tile.types, sensor.array.pitch_um
    betas = sorted({kind.beta for kind in types})
    found = search(stack, betas, kinds, STORE, note, pitch_um)
    note("curves")
    curves = _curves(found.plans[0])
    plan = replace(found.plans[0], designs={beta: one.exact for beta, one in curves.items()})
    found = replace(found, plans=(plan, *found.plans[1:]))
    others = [name for name in tables(stack.process) if name != stack.heights]
    wrong, rays, raised = _compared(plan, others, sensor.optics)
    note("report")
    summary = {
        "process": stack.process,
        "pitch_um": pitch_um,
        "tile": [sensor.tile.rows, sensor.tile.cols],
        "heights": stack.heights,
        "kind": plan.kind,
        "wavelength_um": plan.wavelength_um,
        "betas": [_beta(plan, beta, curves[beta]) for beta in betas],
        "types": [_type(kind, plan, curves) for kind in types],
        "tried": len(found.tried),
        "errors": {f"{beta:g}": [asdict(row) for row in rows] for beta, rows in wrong.items()},
        "wall_s": perf_counter() - start,
    }
    with staged(out, page.NAMES) as folder:
        summary["not_drawn"] = write_tile(plan, sensor.tile, folder / "tile.gds", sensor.array.pitch)
        page.write(folder, sensor.tile, summary, found, curves, raised, wrong, rays)
        names = [name_of(kind) for kind in types]
        axes = axes_of(curves[betas[0]].response)
        shares = stacked(types, plan, curves)
        np.savez_compressed(folder / "response.npz", response=shares, types=names, **axes)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return summary


def _curves(plan: Plan) -> dict[float, Measured]:
    wavelengths = wavelengths_of(plan)
    points = [(beta, d.geometry, float(w)) for beta, d in plan.designs.items() for w in wavelengths]
    jobs = [Job(f"curve-{b:g}-{w:.4f}", solve_one, (g, w), (g, w)) for b, g, w in points]
    solved = run(jobs, STORE, "curves")
    count = len(wavelengths)
    return {
        beta: measured(design, wavelengths, solved[k * count : (k + 1) * count])
        for k, (beta, design) in enumerate(plan.designs.items())
    }


def _compared(
    plan: Plan, others: Sequence[str], optics: OpticsParameters
) -> tuple[dict[float, list[Kept]], dict[float, Floats], dict[str, dict[float, Design]]]:
    """Return errors against run time, rays around the axis, and the other tables of heights, of every design."""
    chosen = [(beta, (design.geometry, plan.wavelength_um)) for beta, design in plan.designs.items()]
    jobs = [
        Job(f"errors-{beta:g}", errors, (*arguments, optics), (*arguments, optics.nu_max, optics.views))
        for beta, arguments in chosen
    ]
    jobs += [Job(f"around-{beta:g}", solve_around, arguments, arguments) for beta, arguments in chosen]
    points = [(name, beta, design) for name in others for beta, design in plan.designs.items()]
    jobs += [
        Job(f"heights-{name}-{beta:g}", at_heights, (design, name), (design, name)) for name, beta, design in points
    ]
    results = iter(run(jobs, STORE, "errors, rays, heights"))
    wrong = {beta: from_json(list[Kept], next(results)) for beta in plan.designs}
    rays = {beta: np.array(next(results)) for beta in plan.designs}
    raised: dict[str, dict[float, Design]] = {name: {} for name in others}
    for name, beta, _ in points:
        raised[name][beta] = from_json(Design, next(results))
    return wrong, rays, raised


def _beta(plan: Plan, beta: float, one: Measured) -> dict[str, Any]:
    geometry = plan.designs[beta].geometry
    names = "diffraction", "analyzer", "period_um", "fill", "analyzer_fill", "shift"
    fields = {name: getattr(geometry, name) for name in names}
    figures = one.fit.as_dict()
    return {"wanted": beta, "reached": plan.reached(beta), **fields, **figures, "bandwidth_um": one.bandwidth_um}


def _type(kind: PixelType, plan: Plan, curves: dict[float, Measured]) -> dict[str, Any]:
    found = curves[nearest(plan, kind.beta)].fit
    names = "beta", "m", "quantum_efficiency", "extinction_ratio", "diattenuation", "residual_rms"
    figures = {name: getattr(found, name) for name in names}
    return {"name": name_of(kind), "alpha": kind.alpha, "gamma": kind.gamma, **figures}
