"""Angular responses of all drawn types, for `PIXEL=`: solved one by one, kept, and written as the table of models."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.pixels.layout.pixel import PixelLayout
from talbot.pixels.layout.section import drawn_curves

STORE = BUILD / "pixel" / "drawn"
DIGITS = 5


def solve_drawn(made: PixelLayout, wavelength_um: float) -> dict[str, Any]:
    """A type's curves, as lists: a job."""
    found = drawn_curves(made, wavelength_um)
    return {"sines": found.sines.round(DIGITS).tolist(), "shares": found.shares.round(DIGITS).tolist()}


def curves(pixels: Sequence[PixelLayout], wavelength_um: float, note: Callable[[str], None]) -> list[dict[str, Any]]:
    """Curves of every type; those of -gamma are gamma's, but for what lies around the pixel: its mirror image."""
    chosen = {(p.kind.beta, p.kind.gamma_deg, round(p.kind.alpha, 6)): p for p in pixels if p.kind.gamma_deg >= 0}
    note(f"curves of {len(chosen)} types")
    jobs = [
        Job(f"drawn-{pixel.name}", solve_drawn, (pixel, wavelength_um), (pixel, wavelength_um))
        for pixel in chosen.values()
    ]
    names = "beta", "gamma_deg", "alpha"
    return [dict(zip(names, map(float, key), strict=True)) | found for key, found in zip(chosen, run(jobs, STORE, "curves"))]


def table(pdk: str, wavelength_um: float, found: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """What `talbot.pixels.tabled` reads."""
    return {
        "command": f"make pixel-layout PDK={pdk} CURVES=models/parameters/pixel_curves.json",
        "process": pdk,
        "wavelength_um": wavelength_um,
        "curves": list(found),
    }
