"""Angular responses of all drawn types, for `PIXEL=`: solved, kept, compared with infinite gratings."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.pixels.layout.pixel import PixelLayout
from talbot.pixels.layout.section import drawn_curves
from talbot.pixels.optics.response import respond
from talbot.platforms.optics import tables

STORE = BUILD / "pixel" / "drawn"
DIGITS = 5
ORDERS = 15  # of the endless gratings
DEGREES = 20  # over which they are compared


@dataclass(frozen=True)
class Kept:
    """A drawn type compared with infinite gratings.

    kept: least-squares share of their (a - b) / (a + b). correlation: of both. light: ratio of the mean.
    """

    kept: float
    correlation: float
    light: float


def solve_drawn(made: PixelLayout, wavelength_um: float) -> dict[str, Any]:
    """Return a type's curves, and those of endless gratings, as lists: a job."""
    found = drawn_curves(made, wavelength_um)
    endless = respond(made.drawn, np.arcsin(found.sines), wavelength_um, orders=ORDERS).unpolarized[0]
    return {
        "sines": found.sines.round(DIGITS).tolist(),
        "shares": found.shares.round(DIGITS).tolist(),
        "endless": endless[list(made.diodes)].round(DIGITS).tolist(),
    }


def curves(pixels: Sequence[PixelLayout], wavelength_um: float) -> list[dict[str, Any]]:
    """Curves of every type. Those of -gamma are taken as gamma's, of which the pixel is nearly the mirror image."""
    chosen = [pixel for pixel in pixels if pixel.kind.gamma_deg >= 0]
    jobs = [Job(f"drawn-{pixel.name}", solve_drawn, (pixel, wavelength_um), (pixel, wavelength_um)) for pixel in chosen]
    kinds = [{"beta": p.kind.beta, "gamma_deg": p.kind.gamma_deg, "alpha": p.kind.alpha} for p in chosen]
    return [kind | found for kind, found in zip(kinds, run(jobs, STORE, "curves"), strict=True)]


def at_heights(pixels: Sequence[PixelLayout], heights: str | None) -> list[PixelLayout]:
    """Return the same masks where the process has another table of heights; None: its first."""
    return [replace(pixel, geometry=replace(pixel.geometry, heights=heights)) for pixel in pixels]


def kept(curve: dict[str, Any]) -> Kept:
    """Return the share of the differences that the drawn pixel of a curve keeps."""
    near = np.abs(curve["sines"]) <= np.sin(np.deg2rad(DEGREES))
    drawn, endless = (np.array(curve[name])[:, near] for name in ("shares", "endless"))
    mine, theirs = ((a - b) / (a + b) for a, b in (drawn, endless))
    return Kept(
        float(mine @ theirs / (theirs @ theirs)),
        float(np.corrcoef(mine, theirs)[0, 1]),
        float(drawn.sum() / endless.sum()),
    )


def table(pdk: str, wavelength_um: float, found: Sequence[dict[str, Any]], heights: str | None) -> dict[str, Any]:
    """Return the data that `talbot.models.parameters.drawn_curves` reads."""
    first = heights in (None, tables(pdk)[0])
    other, of_heights = ("", "") if first else (f"HEIGHTS={heights} ", f"heights {heights}, ")
    light = f"{pdk}, {of_heights}{1e3 * wavelength_um:g} nm"
    return {
        "command": f"make pixel-layout {other}CURVES=models/parameters/pixel_curves{'' if first else '_raised'}.json",
        "source": f"{light}: cuts through the drawn masks, by rigorous coupled waves",
        "curves": [{name: curve[name] for name in curve if name != "endless"} for curve in found],
    }
