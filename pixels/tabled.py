"""A sensor whose pixels respond as a process's gratings do, in place of Eq. 3.1."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD
from talbot.base.sources import code
from talbot.models.parameters import ParameterError, PixelType, SensorParameters, check_choice
from talbot.models.pixel import TableResponse

from .designs import IDEAL, PIXELS, gratings
from .optics.design import REACHED, Design, measure
from .optics.fit import Fit
from .optics.response import bare_share
from .optics.solve import Floats
from .optics.table import ACROSS_DEGREES, along_degrees, angle_table

STORE = BUILD / "pixel" / "tables"


def tabled(sensor: SensorParameters, pixel: str, note: Callable[[str], None] = lambda text: None) -> SensorParameters:
    """``sensor`` with the computed responses of ``pixel``, "ideal" (Eq. 3.1 as it is) or a process's.

    A process's tables are computed once, then kept. note: called with a line about each part that takes long. Types
    with a response of their own stay as they are. Raises ParameterError for a beta without gratings.
    """
    check_choice("pixel", pixel, PIXELS)
    if pixel == IDEAL:
        return sensor
    tables = {beta: _table(pixel, beta, note) for beta in _betas(sensor, pixel)}
    types = tuple(
        kind if kind.response else replace(kind, response=_response(kind, pixel, *tables[_nearest(kind.beta, pixel)]))
        for kind in sensor.tile.types
    )
    return replace(sensor, tile=replace(sensor.tile, types=types))


def rows(alpha: float, found: Fit) -> tuple[int, int]:
    """Diodes of a `Response` for a type: that of the phase nearest to alpha, and the one half a period on."""
    phases = found.alpha + found.turn * np.pi / 2 * np.arange(4)
    first = int(np.argmax(np.cos(phases - alpha)))
    return first, (first + 2) % 4


def _nearest(beta: float, pixel: str) -> float:
    return min(gratings(pixel).geometries, key=lambda b: abs(b - beta))


def _betas(sensor: SensorParameters, pixel: str) -> list[float]:
    wanted = {kind.beta for kind in sensor.tile.types if kind.response is None}
    for beta in wanted:
        near = _nearest(beta, pixel)
        if abs(near - beta) > REACHED * near:
            known = ", ".join(f"{b:g}" for b in gratings(pixel).geometries)
            raise ParameterError(f"beta = {beta:g}: must be one of {known}, which pixel = {pixel!r} has")
    return sorted({_nearest(beta, pixel) for beta in wanted})


def _table(pixel: str, beta: float, note: Callable[[str], None]) -> tuple[Design, Floats]:
    """The design for ``beta`` as it measures, and its table (4, along, across), 1 as a plain diode."""
    chosen = gratings(pixel)
    geometry, wavelength = chosen.geometries[beta], chosen.wavelength_um
    design = measure(geometry, wavelength)
    key = digest(code("talbot.pixels.optics.table"), geometry, wavelength)

    def make(folder: Path) -> None:
        np.save(folder / "table.npy", angle_table(geometry, wavelength, note))

    shares = np.load(cached(STORE / key, make) / "table.npy")
    return design, shares / bare_share(geometry.stack, wavelength)


def _response(kind: PixelType, pixel: str, design: Design, table: Floats) -> TableResponse:
    along, across = np.deg2rad(along_degrees()), np.deg2rad(ACROSS_DEGREES)
    chosen = [*rows(kind.alpha, design.fit)]
    return TableResponse(along, across, np.maximum(table[chosen], 0.0), kind.gamma, f"PIXEL={pixel}")
