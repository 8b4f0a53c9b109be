"""A cut through a whole pixel, rigorous: one period is the pixel, with all that is drawn in it, and light in its wells.

Waves whose directions differ by an order of the period share one solution: that of a few offsets gives the shares of
light from all angles.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import check_int, check_real
from talbot.pixels.optics.geometry import Cutter, Slab
from talbot.pixels.optics.scattering import Complexes, Orders, admittance
from talbot.pixels.optics.solve import Floats, SolverError, scatter
from talbot.platforms.materials import refractive_index
from talbot.platforms.optics import OpticalStack

Spans = tuple[tuple[float, float], ...]  # in um, along the cut


@dataclass(frozen=True)
class Section:
    """The content of a cut in one period.

    metals: spans of each metal, by its LEF name.
    wells: spans of each photodiode.
    """

    period_um: float
    metals: Mapping[str, Spans]
    wells: tuple[Spans, ...]


def slabs(stack: OpticalStack, section: Section, wavelength_um: float) -> list[Slab]:
    """Layers of a cut from the air down to the silicon. Raises ParameterError for a metal that is not in the stack."""
    cut, out = Cutter(stack, wavelength_um), []
    metals = [stack.metal("metal", name) for name, spans in section.metals.items() if spans]
    for metal in sorted(metals, key=lambda item: -item.bottom_um):
        spans = tuple((a / section.period_um, b / section.period_um) for a, b in section.metals[metal.name])
        out += cut.grating("metal", metal.name, 0.0, spans=spans)
    return out + cut.down_to(stack.surface_um)


def section_shares(
    stack: OpticalStack, section: Section, wavelength_um: float, orders: int, offsets: int, most: float
) -> tuple[Floats, Floats, Floats]:
    """Sines (A,) of the angles in the cut, ascending; shares (2, wells, A) of the light on it; all that enters (2, A).

    Polarization first: field along the lines, then across. orders: odd, of the period. offsets: of the direction,
    between two orders. most: sine of the greatest angle. Raises ParameterError, SolverError.
    """
    check_int("orders", orders, 1, 2001)
    check_int("offsets", offsets, 1, 100)
    check_real("most", most, 0, 1)
    step = wavelength_um / section.period_um
    n = np.arange(orders) - orders // 2
    layers, silicon = slabs(stack, section, wavelength_um), complex(refractive_index("silicon", wavelength_um)) ** 2
    inside = [_inside(spans, section.period_um, orders) for spans in section.wells]
    sines, shares, entered = [], [], []
    for offset in (np.arange(offsets) + 0.5) / offsets - 0.5:
        kx = (n + offset) * step
        falling = np.flatnonzero(np.abs(kx) <= most)
        rows = []
        for name in ("te", "tm"):
            waves = Orders(kx, np.zeros(1), name)
            down = scatter(layers, 1.0, silicon, waves, 2 * np.pi / wavelength_um).down[:, falling]
            electric, magnetic = down, _magnetic(silicon, waves)[:, None] * down
            came = _magnetic(1.0, waves)[falling].real
            whole = (electric * magnetic.conj()).real.sum(0) / came
            each = [((electric * (well @ magnetic.conj())).real.sum(0) / came) for well in inside]
            rows.append((whole, each))
        sines.append(kx[falling])
        entered.append(np.array([whole for whole, _ in rows]))
        shares.append(np.array([each for _, each in rows]))
    order = np.argsort(np.concatenate(sines))
    total = np.concatenate(entered, -1)[:, order]
    if not (np.isfinite(total).all() and total.min() > -1e-6 and total.max() < 1 + 1e-6):
        raise SolverError(f"transmitted = {total.min():.6g}..{total.max():.6g}: must be in 0..1")
    return np.concatenate(sines)[order], np.concatenate(shares, -1)[..., order], total


def _magnetic(permittivity: complex, waves: Orders) -> Complexes:
    """H over E of each order (N,), both of the sign with which their product carries power down."""
    ratio = admittance(permittivity, waves)[1][:, 0, 0]
    return -ratio if waves.polarization == "te" else ratio


def _inside(spans: Sequence[tuple[float, float]], period_um: float, orders: int) -> npt.NDArray[np.complex128]:
    """Matrix that gives the power of two sets of orders within spans: sum of e_n m_nk conj(h_k)."""
    n = np.subtract.outer(np.arange(orders), np.arange(orders))
    out = np.zeros((orders, orders), complex)
    for low, high in spans:
        width, middle = (high - low) / period_um, (low + high) / 2 / period_um
        out += width * np.sinc(n * width) * np.exp(2j * np.pi * n * middle)
    return out
