"""Designs that a process can make: candidates under its rules, their neighbours and their figures."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from talbot.models.parameters import ParameterError
from talbot.pixels.optics.fit import Fit, fit
from talbot.pixels.optics.geometry import KINDS, PixelGeometry
from talbot.pixels.optics.response import respond
from talbot.platforms.optics import OpticalStack

WAVELENGTHS_UM = tuple(round(0.45 + 0.025 * k, 3) for k in range(11))
PERIODS_UM = 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2
SEARCH_ORDERS = 21  # shares of light within 0.007 to 0.021 of those of 101 orders: pixels/response/README.md
SEARCH_DEGREES = np.arange(-20, 20.1, 1.0)  # resonances between the gratings are a degree wide
STEPS = {"period_um": 0.04, "fill": 0.07, "analyzer_fill": 0.07}
GATES = 0.45  # share of gates: the space between two is wider than they must be
REACHED = 0.05  # of a beta


@dataclass(frozen=True)
class Design:
    """A geometry, the wavelength it is for, and Eq. 3.1 fitted to its response there."""

    geometry: PixelGeometry
    wavelength_um: float
    fit: Fit

    def off(self, beta: float) -> float:
        """Return the deviation of its beta relative to ``beta``."""
        return abs(self.fit.beta / beta - 1)


def candidates(
    stack: OpticalStack, kinds: Sequence[str] = KINDS, pitch_um: float = PixelGeometry.pitch_um
) -> Iterator[PixelGeometry]:
    """Geometries of the metals of ``stack`` that its rules allow, lines and spaces of one width."""
    names = [metal.name for metal in stack.metals]
    below = {"interleaved": [None], "photogate": [stack.gate.name] if stack.gate else []}
    for kind in kinds:
        for k, upper in enumerate(names):
            for lower in below[kind] if kind != "amplitude" else names[:k]:
                for period in PERIODS_UM:
                    geometry = _made(
                        process=stack.process,
                        heights=stack.heights,
                        kind=kind,
                        diffraction=upper,
                        analyzer=lower,
                        period_um=period,
                        analyzer_fill=GATES if kind == "photogate" else 0.5,
                        pitch_um=pitch_um,
                    )
                    if geometry is not None:
                        yield geometry


def neighbours(design: Design, step: float = 1.0) -> Iterator[PixelGeometry]:
    """Yield geometries a step from ``design`` in one of `STEPS` that the rules allow."""
    grid = design.geometry.stack.grid_um
    for sign in (-step, step):
        for name, size in STEPS.items():
            if name == "analyzer_fill" and not design.geometry.analyzer:
                continue
            value = getattr(design.geometry, name) + sign * size
            if name == "period_um":
                value = round(round(value / grid) * grid, 6)
            geometry = _made(design.geometry, **{name: round(value, 6)})
            if geometry is not None:
                yield geometry


def measure(geometry: PixelGeometry, wavelength_um: float, orders: int = SEARCH_ORDERS) -> Design:
    """Solve a geometry and fit Eq. 3.1. Raises ParameterError, SolverError."""
    response = respond(geometry, np.deg2rad(SEARCH_DEGREES), wavelength_um, orders=orders)
    return Design(geometry, wavelength_um, fit(response))


def phased(design: Design) -> Design:
    """The design with its analyzer where alpha is nearest to 0: lines above one another, or half a period apart."""
    if np.cos(design.fit.alpha) >= 0:
        return design
    shifted = replace(design.geometry, shift=(design.geometry.shift + 0.5) % 1.0)
    alpha = (design.fit.alpha + 2 * np.pi) % (2 * np.pi) - np.pi
    return Design(shifted, design.wavelength_um, replace(design.fit, alpha=float(alpha)))


def front(designs: Sequence[tuple[Design, float]]) -> list[tuple[Design, float]]:
    """Designs and their bandwidths, those that no other beats in modulation depth, quantum efficiency and bandwidth."""
    figures = np.array([(design.fit.m, design.fit.quantum_efficiency, wide) for design, wide in designs]).reshape(-1, 3)
    beaten = [bool(np.any((figures >= figure).all(1) & (figures > figure).any(1))) for figure in figures]
    kept = [candidate for candidate, worse in zip(designs, beaten, strict=True) if not worse]
    return sorted(kept, key=lambda candidate: -candidate[0].fit.m)


def _made(base: PixelGeometry | None = None, **changes: object) -> PixelGeometry | None:
    """Return a geometry, or None where a rule forbids it."""
    try:
        geometry = PixelGeometry(**changes) if base is None else replace(base, **changes)  # pyright: ignore[reportArgumentType]
        geometry.layers(WAVELENGTHS_UM[0])  # its metals lie inside one film
    except ParameterError:
        return None
    return geometry
