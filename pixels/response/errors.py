"""Error against run time: orders and other settings compared with a converged solution, and their seconds."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import CubicSpline

from talbot.models.parameters import OpticsParameters
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.response import respond
from talbot.pixels.optics.scalar import crosstalk
from talbot.pixels.optics.solve import Floats
from talbot.pixels.optics.table import BAND_UM, ORDERS

DEGREES = 0.0, 7.0, 14.0
ORDERS_KEPT, ORDERS_ALL = (11, 15, 21, 31, 41, 61), 101
BAND_KEPT, BAND_ALL = (1, 3, 5, 9), 33
STEPS_KEPT, STEP_LEAST, EDGE = (4.0, 2.0, 1.0, 0.5), 0.25, 24.0  # degrees
NODES_KEPT, NODES_ALL = (1, 3, 5, 9), 41
SAMPLES_KEPT, SAMPLES_ALL = (1024, 2048, 4096, 8192), 65536


@dataclass(frozen=True)
class Kept:
    """A row. what: "orders", ...; kept: how many of it. error: greatest, of a share of light. seconds: to solve."""

    what: str
    kept: float
    error: float
    seconds: float


def errors(geometry: PixelGeometry, wavelength_um: float, optics: OpticsParameters) -> list[Kept]:
    """All rows of a geometry: a job. Angles are in the plane across the lines.

    orders: of a solution at `DEGREES`, against `ORDERS_ALL`. wavelengths: spread evenly over the filter's `BAND_UM`,
    their mean. degrees: step of a table that is cubic between its angles, at all angles `STEP_LEAST` apart. angles in
    a view: Gaussian nodes in the cell of each view of the lens of ``optics``, the mean over the cell. samples: of the
    field in scalar waves, the share that leaves a pixel (amplitude gratings alone).
    """
    rows = [*_orders(geometry, wavelength_um), *_wavelengths(geometry, wavelength_um)]
    rows += _angles(geometry, wavelength_um, optics)
    return rows + ([*_samples(geometry, wavelength_um)] if geometry.kind == "amplitude" else [])


def _orders(geometry: PixelGeometry, wavelength_um: float) -> Iterator[Kept]:
    def solved(orders: int) -> Floats:
        return respond(geometry, np.deg2rad(DEGREES), wavelength_um, orders=orders).shares

    return _rows("orders", ORDERS_KEPT, solved(ORDERS_ALL), solved)


def _wavelengths(geometry: PixelGeometry, wavelength_um: float) -> Iterator[Kept]:
    def solved(count: int) -> Floats:
        over = wavelength_um + BAND_UM * ((np.arange(count) + 0.5) / count - 0.5)
        return respond(geometry, np.deg2rad(DEGREES), over, orders=ORDERS).unpolarized.mean(0)

    return _rows("wavelengths", BAND_KEPT, solved(BAND_ALL), solved)


def _angles(geometry: PixelGeometry, wavelength_um: float, optics: OpticsParameters) -> Iterator[Kept]:
    def table(step: float) -> Floats:
        return respond(geometry, np.deg2rad(_spread(step)), wavelength_um, orders=ORDERS).unpolarized[0]

    fine, truth = _spread(STEP_LEAST), table(STEP_LEAST)

    def read(step: float) -> Floats:
        return CubicSpline(_spread(step), table(step), axis=1)(fine)

    yield from _rows("degrees", STEPS_KEPT, truth, read)
    between = CubicSpline(np.deg2rad(fine), truth, axis=1)
    edges = optics.nu_max * np.linspace(-1, 1, optics.views + 1)

    def cells(nodes: int) -> tuple[Floats, Floats]:
        """Angles (views, nodes) and their weights (nodes,)."""
        place, weight = leggauss(nodes)
        middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
        return np.arctan(middle[:, None] + half[:, None] * place), weight / 2

    def view(nodes: int) -> Floats:
        angles, weights = cells(nodes)
        found = respond(geometry, angles.ravel(), wavelength_um, orders=ORDERS).unpolarized[0]
        return found.reshape(-1, *angles.shape) @ weights

    angles, weights = cells(NODES_ALL)
    yield from _rows("angles in a view", NODES_KEPT, between(angles) @ weights, view)


def _samples(geometry: PixelGeometry, wavelength_um: float) -> Iterator[Kept]:
    def left(samples: int) -> Floats:
        return crosstalk(geometry, np.deg2rad(DEGREES), wavelength_um, samples)

    return _rows("samples", SAMPLES_KEPT, left(SAMPLES_ALL), left)


def _spread(step: float) -> Floats:
    return np.arange(-EDGE, EDGE + step / 2, step)


def _rows(
    what: str, kept: Sequence[int] | Sequence[float], truth: Floats, solved: Callable[[Any], Floats]
) -> Iterator[Kept]:
    """Yield a row for each of ``kept``, against ``truth``."""
    for count in kept:
        start = perf_counter()
        found = solved(count)
        yield Kept(what, count, float(np.abs(found - truth).max()), perf_counter() - start)
