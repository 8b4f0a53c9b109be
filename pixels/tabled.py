"""A sensor whose pixels have the response of a process's gratings instead of Eq. 3.1."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from talbot.base.cache import cached, digest
from talbot.base.paths import BUILD
from talbot.base.sensor import Varied
from talbot.base.sources import code
from talbot.models.parameters import ParameterError, PixelType, SensorParameters, check_choice, drawn_curves
from talbot.models.parameters.drawn import CURVES
from talbot.models.parameters.drawn import RAISED as CURVES_RAISED
from talbot.models.pixel import TableResponse
from talbot.pixels.designs import DRAWN, IDEAL, PIXELS, RAISED, gratings
from talbot.pixels.drawn import DRAWN_PITCH
from talbot.pixels.measured import SUFFIX, read_responses, sine_of_walk
from talbot.pixels.optics.design import REACHED, Design, measure
from talbot.pixels.optics.fit import Fit
from talbot.pixels.optics.response import bare_share
from talbot.pixels.optics.solve import Floats
from talbot.pixels.optics.table import ACROSS_DEGREES, along_degrees, angle_table

STORE = BUILD / "pixel" / "tables"
DRAWN_ALONE = Varied(("tile", "optics"), DRAWN_PITCH)
SOURCE = "PIXEL="  # of a response, and the pixel behind it
DRAWN_CURVES = dict.fromkeys(DRAWN, CURVES) | {name + RAISED: CURVES_RAISED for name in DRAWN}


def tabled(sensor: SensorParameters, pixel: str, note: Callable[[str], None] = lambda text: None) -> SensorParameters:
    """``sensor`` with the responses of ``pixel``, "ideal" (Eq. 3.1 as it is), a process's, or those of a response.npz.

    Pixels that are drawn respond as they are drawn (`layout.section`), others and those named "-endless" as endless
    gratings: their tables are computed once, then kept. "-raised" has the process's second table of heights. note:
    called with a line about each part that takes long. Types with a response stay as they are, except with a
    response.npz. Raises ParameterError for a beta without gratings, or for an angle at which nothing is drawn.
    """
    if pixel.endswith(SUFFIX):
        types = read_responses(pixel, sensor.tile.types, SOURCE)
        return replace(sensor, tile=replace(sensor.tile, types=types))
    check_choice("pixel", pixel, (*PIXELS, "a response.npz"))
    if pixel == IDEAL:
        return sensor
    if pixel in DRAWN_CURVES:
        DRAWN_ALONE.check(sensor)
    for beta in _betas(sensor, pixel):
        if pixel not in DRAWN_CURVES:
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
    """Return the source of a response set by `tabled`; '' for any other response."""
    source = getattr(kind.response, "source", "")
    return source if source.startswith(SOURCE) else ""


def rows(alpha: float, fit: Fit) -> tuple[int, int]:
    """Diodes of a `Response` for a type: that of the phase nearest to alpha, and the one half a period on."""
    phases = fit.alpha + fit.turn * np.pi / 2 * np.arange(4)
    first = int(np.argmax(np.cos(phases - alpha)))
    return first, (first + 2) % 4


def nearest_beta(beta: float, pixel: str) -> float:
    """Return the beta of ``pixel``'s gratings that is nearest to ``beta``."""
    return min(gratings(pixel).geometries, key=lambda b: abs(b - beta))


def _betas(sensor: SensorParameters, pixel: str) -> list[float]:
    betas = {kind.beta for kind in sensor.tile.types if kind.response is None}
    for beta in betas:
        near = nearest_beta(beta, pixel)
        if abs(near - beta) > REACHED * near:
            known = ", ".join(f"{b:g}" for b in gratings(pixel).geometries)
            raise ParameterError(f"beta = {beta:g}: must be one of {known}, which pixel = {pixel!r} has")
    return sorted({nearest_beta(beta, pixel) for beta in betas})


def _table(pixel: str, beta: float, note: Callable[[str], None] = lambda text: None) -> Path:
    """Return the folder with the table for ``beta``."""
    chosen = gratings(pixel)
    geometry, wavelength = chosen.geometries[beta], chosen.wavelength_um
    key = digest(code("talbot.pixels.optics.table"), geometry, wavelength)

    def make(folder: Path) -> None:
        np.save(folder / "table.npy", angle_table(geometry, wavelength, note))

    return cached(STORE / key, make)


@lru_cache(maxsize=16)
def _loaded(pixel: str, beta: float) -> tuple[Design, Floats]:
    """Return the design for ``beta`` as it measures, and its table (4, along, across), 1 as a plain diode."""
    chosen = gratings(pixel)
    geometry, wavelength = chosen.geometries[beta], chosen.wavelength_um
    shares = np.load(_table(pixel, beta) / "table.npy")
    return measure(geometry, wavelength), shares / bare_share(geometry.stack, wavelength)


@lru_cache(maxsize=256)  # sensors of the same pixels are equal
def _response(kind: PixelType, pixel: str) -> TableResponse:
    along, across = np.deg2rad(along_degrees()), np.deg2rad(ACROSS_DEGREES)
    if pixel in DRAWN_CURVES:
        values = _drawn(kind, pixel, along, across)
    else:
        design, table = _loaded(pixel, nearest_beta(kind.beta, pixel))
        values = table[[*rows(kind.alpha, design.fit)]]
    return TableResponse(along, across, np.maximum(values, 0.0), kind.gamma, f"{SOURCE}{pixel}")


def _drawn(kind: PixelType, pixel: str, along: Floats, across: Floats) -> Floats:
    """Response (2, along, across) of a drawn type, 1 as a plain diode. Raises ParameterError.

    Its curve is solved for rays across the lines. Of others counts how far they walk in that direction on their way
    through the oxide, which is where the phase comes from.
    """
    chosen, beta = gratings(pixel), nearest_beta(kind.beta, pixel)
    curves = {(g, a): curve for (b, g, a), curve in drawn_curves(DRAWN_CURVES[pixel]).items() if b == beta}
    angles = sorted({g for g, _ in curves})
    if abs(kind.gamma_deg) not in angles:
        known = ", ".join(f"{angle:g}" for angle in angles)
        raise ParameterError(
            f"gamma_deg = {kind.gamma_deg:g}: must be one of {known}, of either sign, at which beta {beta:g} of "
            f"pixel = {pixel!r} is drawn"
        )
    # Diodes of a type half a period on are those of this one, exchanged
    turns = [(a + half, a, half > 0) for g, a in curves if g == abs(kind.gamma_deg) for half in (0.0, np.pi)]
    _, alpha, swapped = max(turns, key=lambda turn: np.cos(turn[0] - kind.alpha))
    sines, *shares = curves[abs(kind.gamma_deg), alpha]
    at = np.clip(sine_of_walk(along, across, chosen.wavelength_um), sines[0], sines[-1])
    stack = chosen.geometries[beta].stack
    from scipy.interpolate import CubicSpline  # imported where it is needed: it is slow

    diodes = np.array([CubicSpline(sines, share)(at) for share in shares]) / bare_share(stack, chosen.wavelength_um)
    return diodes[::-1] if swapped else diodes
