"""A sensor's pixels in light with a spectrum: responses averaged over the electrons of its wavelengths."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from talbot.base.cache import cached, digest
from talbot.base.sources import code
from talbot.models.parameters import ParameterError, PixelType, SensorParameters, SpectralParameters, Spectrum
from talbot.models.pixel import TableResponse
from talbot.pixels.designs import IDEAL, gratings
from talbot.pixels.measured import SUFFIX, sine_of_walk
from talbot.pixels.optics.design import Design, measure
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.response import Response, bare_share
from talbot.pixels.optics.solve import Floats
from talbot.pixels.optics.table import ACROSS_DEGREES, along_degrees, spectral_curves
from talbot.pixels.tabled import DRAWN_CURVES, SOURCE, STORE, nearest_beta, pixel_of, rows

GRID_UM = tuple(round(0.38 + 0.01 * k, 2) for k in range(41))  # wavelengths at which gratings are solved


def in_light(
    sensor: SensorParameters, lamp: Spectrum, reflectance: str = "gray", note: Callable[[str], None] = lambda text: None
) -> SensorParameters:
    """``sensor`` with the response of its pixels in a light, averaged with `SpectralParameters.electrons`.

    Pixels of Eq. 3.1 keep beta, and have a smaller m each (`SpectralParameters.depth`). Infinite gratings are solved at
    `GRID_UM`, or at a laser's wavelength; shares are linear in between. note: called with a line about each part that
    takes long. Raises ParameterError for pixels whose response at other wavelengths is not known.
    """
    pixel, given = pixel_of(sensor), f"light = {lamp.name!r}: must be left out with"
    if pixel in DRAWN_CURVES:
        raise ParameterError(f"{given} pixel = {pixel}, which was solved at one wavelength; sky130-endless takes it")
    if pixel.endswith(SUFFIX) or pixel == IDEAL and any(kind.response for kind in sensor.tile.types):
        raise ParameterError(f"{given} responses of a file or a function, which have no wavelength")
    if pixel == IDEAL:
        depths = {kind.beta: sensor.spectral.depth(kind.beta, lamp, reflectance) for kind in sensor.tile.types}
        types = tuple(_formula(kind, sensor.optics.m, depths[kind.beta]) for kind in sensor.tile.types)
    else:
        for geometry in gratings(pixel).geometries.values():
            curves_in_light(geometry, lamp, reflectance, sensor.spectral, note)
        types = tuple(_table(kind, pixel, lamp, reflectance, sensor.spectral) for kind in sensor.tile.types)
    return replace(sensor, tile=replace(sensor.tile, types=types))


def _formula(kind: PixelType, m: float, depth: float) -> PixelType:
    """Return a type with ``depth`` of its m, by default ``m``; fringes that are inverted move alpha by half a turn."""
    m = depth * (m if kind.m is None else kind.m)
    alpha = kind.alpha if m >= 0 else kind.alpha - np.copysign(np.pi, kind.alpha)
    return replace(kind, m=abs(m), alpha=float(alpha))


def shares_on_grid(grid_um: Floats, wavelengths: Floats, weights: Floats) -> Floats:
    """Weights (n,) on ``grid_um`` of which a sum is that over ``wavelengths`` in m of a function linear in between."""
    return np.array([np.interp(1e6 * wavelengths, grid_um, unit) @ weights for unit in np.eye(len(grid_um))])


def curves_in_light(
    geometry: PixelGeometry,
    lamp: Spectrum,
    reflectance: str,
    spectral: SpectralParameters,
    note: Callable[[str], None] = lambda text: None,
) -> tuple[Floats, Floats, Floats]:
    """Wavelengths in um (n,), their weights (n,) in the electrons, and shares (n, 2, 4, along) of `spectral_curves`.

    Computed once for a geometry, then kept.
    """
    nodes, electrons = spectral.electrons(lamp, reflectance)
    grid = np.array(GRID_UM) if nodes.size > 1 else 1e6 * nodes
    key = digest(code("talbot.pixels.optics.table"), geometry, tuple(grid.tolist()), "spectrum")

    def make(folder: Path) -> None:
        np.save(folder / "curves.npy", spectral_curves(geometry, grid, note))

    return grid, shares_on_grid(grid, nodes, electrons), np.load(cached(STORE / key, make) / "curves.npy")


def response_in_light(
    geometry: PixelGeometry, wavelength_um: float, lamp: Spectrum, spectral: SpectralParameters, degrees: float = 20.0
) -> Response:
    """Mean response of infinite gratings over a light, at angles across the lines up to ``degrees``.

    wavelength_um: the label of the mean. Reflected light is left out, 0.
    """
    _, weights, shares = curves_in_light(geometry, lamp, "gray", spectral)
    near = np.abs(along_degrees()) <= degrees
    mean, angles = np.tensordot(weights, shares, 1)[None][..., near], np.deg2rad(along_degrees()[near])
    return Response(geometry, angles, 0 * angles, np.array([wavelength_um]), mean, 0 * mean)


@lru_cache(maxsize=16)
def _design(geometry: PixelGeometry, wavelength_um: float) -> Design:
    return measure(geometry, wavelength_um)


@lru_cache(maxsize=32)
def _averaged(geometry: PixelGeometry, lamp: Spectrum, reflectance: str, spectral: SpectralParameters) -> Floats:
    """Table (4, along, across) of infinite gratings in a light, 1 as a plain diode in it."""
    from scipy.interpolate import CubicSpline  # imported where it is needed: it is slow

    along, across = np.deg2rad(along_degrees()), np.deg2rad(ACROSS_DEGREES)
    grid, weights, curves = curves_in_light(geometry, lamp, reflectance, spectral)
    total, bare = np.zeros((4, along.size, across.size)), 0.0
    for wavelength, weight, shares in zip(grid.tolist(), weights, curves, strict=True):
        at = np.clip(sine_of_walk(along, across, wavelength), np.sin(along[0]), np.sin(along[-1]))
        total += weight * CubicSpline(np.sin(along), shares.mean(0), axis=1)(at)
        bare += weight * bare_share(geometry.stack, wavelength)
    return total / bare


@lru_cache(maxsize=256)  # sensors of the same pixels are equal
def _table(kind: PixelType, pixel: str, lamp: Spectrum, reflectance: str, spectral: SpectralParameters) -> PixelType:
    chosen = gratings(pixel)
    geometry = chosen.geometries[nearest_beta(kind.beta, pixel)]
    fit = _design(geometry, chosen.wavelength_um).fit
    values = _averaged(geometry, lamp, reflectance, spectral)[[*rows(kind.alpha, fit)]]
    along, across = np.deg2rad(along_degrees()), np.deg2rad(ACROSS_DEGREES)
    return replace(kind, response=TableResponse(along, across, np.maximum(values, 0.0), kind.gamma, f"{SOURCE}{pixel}"))
