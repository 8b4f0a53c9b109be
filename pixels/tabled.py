"""A sensor whose pixels respond as a process's gratings do, in place of Eq. 3.1."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
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
SOURCE = "PIXEL="  # of a response, and the pixel behind it


def tabled(sensor: SensorParameters, pixel: str, note: Callable[[str], None] = lambda text: None) -> SensorParameters:
    """``sensor`` with the computed responses of ``pixel``, "ideal" (Eq. 3.1 as it is) or a process's.

    A process's tables are computed once, then kept. note: called with a line about each part that takes long. Types
    with a response of their own stay as they are. Raises ParameterError for a beta without gratings.
    """
    check_choice("pixel", pixel, PIXELS)
    if pixel == IDEAL:
        return sensor
    for beta in _betas(sensor, pixel):
        _table(pixel, beta, note)
    types = tuple(
        kind if kind.response else replace(kind, response=_response(kind, pixel)) for kind in sensor.tile.types
    )
    return replace(sensor, tile=replace(sensor.tile, types=types))


def pixel_of(sensor: SensorParameters) -> str:
    """The ``pixel`` whose responses a sensor's types have, as `tabled` gave them; "ideal" where they have none."""
    sources = {_source(kind) for kind in sensor.tile.types} - {""}
    return sources.pop().removeprefix(SOURCE) if len(sources) == 1 else IDEAL


def untabled(sensor: SensorParameters) -> SensorParameters:
    """``sensor`` without what `tabled` gave it."""
    if pixel_of(sensor) == IDEAL:
        return sensor
    types = tuple(replace(kind, response=None) if _source(kind) else kind for kind in sensor.tile.types)
    return replace(sensor, tile=replace(sensor.tile, types=types))


def _source(kind: PixelType) -> str:
    """What `tabled` names as the source of a type's response; '' for any other response."""
    found = getattr(kind.response, "source", "")
    return found if found.startswith(SOURCE) else ""


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


def _table(pixel: str, beta: float, note: Callable[[str], None] = lambda text: None) -> Path:
    """The folder with the table for ``beta``."""
    chosen = gratings(pixel)
    geometry, wavelength = chosen.geometries[beta], chosen.wavelength_um
    key = digest(code("talbot.pixels.optics.table"), geometry, wavelength)

    def make(folder: Path) -> None:
        np.save(folder / "table.npy", angle_table(geometry, wavelength, note))

    return cached(STORE / key, make)


@lru_cache(maxsize=16)
def _loaded(pixel: str, beta: float) -> tuple[Design, Floats]:
    """The design for ``beta`` as it measures, and its table (4, along, across), 1 as a plain diode."""
    chosen = gratings(pixel)
    geometry, wavelength = chosen.geometries[beta], chosen.wavelength_um
    shares = np.load(_table(pixel, beta) / "table.npy")
    return measure(geometry, wavelength), shares / bare_share(geometry.stack, wavelength)


@lru_cache(maxsize=256)  # sensors of the same pixels are equal
def _response(kind: PixelType, pixel: str) -> TableResponse:
    design, table = _loaded(pixel, _nearest(kind.beta, pixel))
    along, across = np.deg2rad(along_degrees()), np.deg2rad(ACROSS_DEGREES)
    chosen = [*rows(kind.alpha, design.fit)]
    return TableResponse(along, across, np.maximum(table[chosen], 0.0), kind.gamma, f"{SOURCE}{pixel}")
