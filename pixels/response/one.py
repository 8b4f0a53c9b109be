"""One geometry of the command line: its response over angle, and Eq. 3.1 fitted to it."""

import json
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from talbot.base.files import check_folder, staged
from talbot.models.parameters import SpectralParameters, Spectrum
from talbot.pixels.lit import response_in_light
from talbot.pixels.optics.fit import fit
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.response import respond
from talbot.pixels.response.types import DEGREES, axes_of

NAMES = "summary.json", "response.npz"


def make(
    geometry: PixelGeometry,
    wavelength_um: float,
    out: Path,
    lamp: Spectrum | None = None,
    spectral: SpectralParameters | None = None,
) -> dict[str, Any]:
    """Solve it, write response.npz and summary.json into ``out``; returns the summary. Raises ParameterError.

    lamp: the light over which the response is averaged, None for one wavelength. spectral: of the sensor.
    """
    check_folder("out", out, NAMES)
    start = perf_counter()
    if lamp is None:
        found = respond(geometry, np.deg2rad(DEGREES), wavelength_um)
    else:
        found = response_in_light(geometry, wavelength_um, lamp, spectral or SpectralParameters(), float(DEGREES.max()))
    light = {"wavelength_um": wavelength_um, "light": lamp and lamp.name}
    summary = asdict(geometry) | light | fit(found).as_dict()
    summary["wall_s"] = perf_counter() - start
    with staged(out, NAMES) as folder:
        shares = found.shares[0].transpose(1, 2, 0)[:, :, None]  # diode, angle, wavelength, polarization
        np.savez_compressed(folder / "response.npz", response=shares, **axes_of(found))
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return summary
