"""The light in each photodiode under a stack of layers, over angles, polarizations and analyzer shifts."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_int, check_real
from talbot.pixels.optics.geometry import Slab
from talbot.pixels.optics.grating import grating, moved
from talbot.pixels.optics.scattering import Complexes, Orders, Scattering, admittance, films

ORDERS = 41  # kept, the even number of evanescent and travelling ones about order 0
BATCH = 24  # angles at once: memory
THICKEST = 1e6  # um
BALANCE = 1e-6  # by which reflected and transmitted light may exceed what came
Floats = npt.NDArray[np.floating]


class SolverError(ArithmeticError):
    """A solution breaks a law that it must obey: too few orders for this geometry, or a resonance without loss."""


@dataclass(frozen=True)
class Illumination:
    """Plane waves of one wavelength onto a stack.

    wavelength_um: in vacuum.
    along: (A,), rad between the ray's projection and the normal in the plane across the lines, |angle| < pi/2.
    across: (A,), the same in the plane along the lines.
    top, bottom: permittivity above (without loss) and below.
    """

    wavelength_um: float
    along: Floats
    across: Floats
    top: complex = 1.0
    bottom: complex = 1.0

    def __post_init__(self) -> None:
        check_real("wavelength_um", self.wavelength_um, 1e-3, 1e3)
        if self.along.ndim != 1 or self.along.shape != self.across.shape or not self.along.size:
            raise ParameterError(f"angles = array of shape {self.along.shape}: must be a list of one or more")
        for name in ("along", "across"):
            worst = np.max(np.abs(getattr(self, name)))
            if not worst < np.pi / 2:
                raise ParameterError(f"{name} = {worst:g}: must be an angle in rad below pi/2")

    def directions(self) -> Floats:
        """Direction cosines (3, A) across the lines, along them and down."""
        tangents = np.tan(self.along), np.tan(self.across)
        down = 1 / np.sqrt(1 + tangents[0] ** 2 + tangents[1] ** 2)
        return np.stack([tangents[0] * down, tangents[1] * down, down])


@dataclass(frozen=True)
class Light:
    """Shares of the incident light, (2, shifts, ..., A); polarization first: field along the lines, then across.

    reflected: all reflected light.
    transmitted: all light that enters the half space below.
    fingers: (2, shifts, 2, A), of that through the half of each period around x = shift and through the other half, or
        None.
    """

    reflected: Floats
    transmitted: Floats
    fingers: Floats | None


def solve(
    upper: Sequence[Slab],
    lower: Sequence[Slab],
    period_um: float,
    light: Illumination,
    shifts: Sequence[float] = (0.0,),
    orders: int = ORDERS,
    fingers: bool = False,
) -> Light:
    """Light through ``upper`` and then ``lower``, whose lines are moved by each of ``shifts`` periods.

    fingers: divide what enters between fingers of two diodes, which move with the shift. orders: odd, 1..401. Raises
    SolverError.
    """
    check_int("orders", orders, 1, 401)
    check_real("period_um", period_um, 1e-3, 1e3)
    if orders % 2 == 0:
        raise ParameterError(f"orders = {orders}: must be odd")
    oblique = np.abs(light.across) > 0
    out = [np.zeros((2, len(shifts), *more, light.along.size)) for more in ([], [], [2])[: 3 if fingers else 2]]
    for across in (False, True):
        chosen = np.flatnonzero(oblique == across)
        for at in np.split(chosen, range(BATCH, chosen.size, BATCH)):
            if not at.size:
                continue
            part = Illumination(light.wavelength_um, light.along[at], light.across[at], light.top, light.bottom)
            for name in ("both",) if across else ("te", "tm"):
                rows = {"te": [0], "tm": [1], "both": [0, 1]}[name]
                try:
                    light_of_part = _solve(upper, lower, period_um, part, shifts, orders, name, fingers)
                except np.linalg.LinAlgError as error:
                    raise SolverError(f"modes = none: must be found ({error})") from None
                for whole, piece in zip(out, light_of_part, strict=True):
                    for row, values in zip(rows, piece, strict=True):
                        whole[row][..., at] = values
    _check(out[0], out[1])
    return Light(out[0], out[1], out[2] if fingers else None)


def _check(reflected: Floats, transmitted: Floats) -> None:
    total = reflected + transmitted
    if not (
        np.isfinite(total).all() and min(reflected.min(), transmitted.min()) > -BALANCE and total.max() < 1 + BALANCE
    ):
        raise SolverError(
            f"reflected + transmitted = {total.min():.6g}..{total.max():.6g}: must be in 0..1; "
            "other orders, or a slightly different angle, may work"
        )


def _solve(
    upper: Sequence[Slab],
    lower: Sequence[Slab],
    period_um: float,
    light: Illumination,
    shifts: Sequence[float],
    count: int,
    polarization: str,
    fingers: bool,
) -> list[Floats]:
    """Solve one set of components: (P, shifts, A), (P, shifts, A), and with fingers (P, shifts, 2, A)."""
    wave = 2 * np.pi / light.wavelength_um
    x, y, _ = light.directions() * np.sqrt(light.top).real
    kx = x[:, None] + (np.arange(count) - count // 2) * light.wavelength_um / period_um
    orders = Orders(kx, y[:, None], polarization)
    between = upper[-1].medium if lower else light.bottom
    first = scatter(upper, light.top, between, orders, wave)
    falling = _incident(orders, light)
    last = scatter(lower, between, light.bottom, orders, wave) if lower else None
    _, y_top = admittance(light.top, orders)
    _, y_bottom = admittance(light.bottom, orders)
    came = _flux(falling[..., 0], y_top, orders).sum(-1)  # that of both fields is the same
    shares: list[list[Floats]] = [[], [], []] if fingers else [[], []]
    for shift in shifts:
        if last is None:
            back, through = first.above @ falling, first.down @ falling
        else:
            here = moved(last, shift, orders)
            into = np.linalg.solve(np.eye(falling.shape[-2]) - first.below @ here.above, first.down @ falling)
            back, through = first.above @ falling + first.up @ (here.above @ into), here.down @ into
        for k in range(falling.shape[-1]):
            shares[0].append(_flux(back[..., k], y_top, orders).sum(-1) / came)
            shares[1].append(_flux(through[..., k], y_bottom, orders).sum(-1) / came)
            if fingers:
                shares[2].append(_fingers(through[..., k], y_bottom, orders, shift) / came)
    p = falling.shape[-1]
    return [np.stack(rows).reshape(len(shifts), p, *rows[0].shape).swapaxes(0, 1) for rows in shares]


def scatter(slabs: Sequence[Slab], above: complex, below: complex, orders: Orders, wave: float) -> Scattering:
    """Scattering of layers between two media. wave: 2 pi / wavelength in 1/um."""
    stack: Scattering | None = None
    run: list[tuple[complex, float]] = [(above, 0.0)]

    def close(medium: complex) -> None:
        nonlocal stack
        part = films([*run, (medium, 0.0)], orders).spread()
        stack = part if stack is None else stack.over(part)

    for slab in slabs:
        check_real("thickness_um", slab.thickness_um, 0, THICKEST)
        if slab.line is None:
            run.append((slab.medium, wave * slab.thickness_um))
            continue
        close(slab.medium)
        assert stack is not None
        stack = stack.over(grating(slab, wave * slab.thickness_um, orders))
        run = [(slab.medium, 0.0)]
    close(below)
    assert stack is not None
    return stack


def _incident(orders: Orders, light: Illumination) -> Complexes:
    """Amplitudes (A, cN, P) of waves of equal power: field along the lines as far as it can be, and across."""
    angles, count = orders.kx.shape
    if orders.components == 1:
        out = np.zeros((angles, count, 1), complex)
        out[:, count // 2, 0] = 1
        return out
    ray = light.directions().T
    along = np.array([0, 1, 0]) - ray * ray[:, 1:2]
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    out = np.zeros((angles, 2 * count, 2), complex)
    for k, field in enumerate((along, np.cross(along, ray))):
        out[:, count // 2, k], out[:, count + count // 2, k] = field[:, 0], field[:, 1]
    return out


def _split(amplitudes: Complexes, y: Complexes, orders: Orders) -> tuple[list[Complexes], list[Complexes]]:
    """Ex, Ey and Hy, -Hx of each order (A, N), those that there are."""
    count, c = orders.kx.shape[-1], orders.components
    electric = amplitudes.reshape(-1, c, count).swapaxes(1, 2)
    magnetic = (y @ electric[..., None])[..., 0]
    if c == 1:
        return [electric[..., 0]], [magnetic[..., 0] * (-1 if orders.polarization == "te" else 1)]
    return [electric[..., 0], electric[..., 1]], [magnetic[..., 1], -magnetic[..., 0]]


def _flux(amplitudes: Complexes, y: Complexes, orders: Orders) -> Floats:
    """Power that each order (A, N) carries along z."""
    return sum(((e * h.conj()).real / 2 for e, h in zip(*_split(amplitudes, y, orders), strict=True)), np.zeros(()))


def _fingers(amplitudes: Complexes, y: Complexes, orders: Orders, shift: float) -> Floats:
    """Power through the half of each period around x = shift periods, and through the rest, (2, A)."""
    count = orders.kx.shape[-1]
    n = np.subtract.outer(np.arange(count), np.arange(count))
    half = np.sinc(n / 2) / 2 * np.exp(2j * np.pi * n * shift)
    inside, total = np.zeros(len(amplitudes)), np.zeros(len(amplitudes))
    for e, h in zip(*_split(amplitudes, y, orders), strict=True):
        inside = inside + np.einsum("an,nm,am->a", e, half, h.conj()).real / 2
        total = total + (e * h.conj()).real.sum(-1) / 2
    return np.stack([inside, total - inside])
