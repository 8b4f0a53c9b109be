"""One geometry, asked for by its fields: its response over angle, and Eq. 3.1 beside it."""

import json
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from talbot.base.files import check_folder, staged
from talbot.pixels.optics.fit import fit
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.response import respond

from .types import DEGREES

NAMES = "summary.json", "response.npz"


def make(geometry: PixelGeometry, wavelength_um: float, out: Path) -> dict[str, Any]:
    """Solve it, write response.npz and summary.json into ``out``; returns the summary. Raises ParameterError."""
    check_folder("out", out)
    start = perf_counter()
    found = respond(geometry, np.deg2rad(DEGREES), wavelength_um)
    summary = asdict(geometry) | {"wavelength_um": wavelength_um} | fit(found).as_dict()
    summary["wall_s"] = perf_counter() - start
    with staged(out, NAMES) as folder:
        np.savez_compressed(
            folder / "response.npz",
            response=found.shares[0].transpose(1, 2, 0)[:, :, None],  # diode, angle, wavelength, polarization
            angles=found.angles,
            wavelengths=1e-6 * found.wavelengths_um,
            polarizations=["along the lines", "across the lines"],
        )
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n")
    return summary


def show(s: dict[str, Any], folder: Path) -> None:
    """Print the figures."""
    metals = s["diffraction"] + (f" over {s['analyzer']}" if s["analyzer"] else "")
    wavelength = f"{1e3 * s['wavelength_um']:.0f} nm"
    print(f"{s['process']}: {s['kind']} pixel, {metals}, period {s['period_um']:g} um, at {wavelength}")
    print(
        f"  alpha {s['alpha']:.2f} rad, beta {s['beta']:.1f}, m {s['m']:.2f}, quantum efficiency "
        f"{s['quantum_efficiency']:.3f}, extinction ratio {s['extinction_ratio']:.2f}, residual of Eq. 3.1 "
        f"{s['residual_rms']:.2f} rms"
    )
    print(f"  {s['wall_s']:.1f} s; look at {folder / 'response.npz'}")
