"""The field between the gratings, for a picture."""

import numpy as np

from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.grating import moved
from talbot.pixels.optics.scattering import Orders, admittance
from talbot.pixels.optics.solve import Floats, scatter
from talbot.platforms.materials import refractive_index

ORDERS = 41
DEEPEST = 30.0  # exponents of evanescent waves beyond this are left out: they have died away


def field_between(geometry: PixelGeometry, angle: float, wavelength_um: float, x_um: Floats, up_um: Floats) -> Floats:
    """|Ey|^2 (up, x) between the gratings of an amplitude pixel, of a wave of amplitude 1, field along the lines.

    angle: in rad in air, in the plane across the lines. x_um: from the middle of an upper line. up_um: above the
    analyzer, 0..`PixelGeometry.gap_um`.
    """
    upper, lower = geometry.layers(wavelength_um)
    wave = 2 * np.pi / wavelength_um
    n = np.arange(ORDERS) - ORDERS // 2
    kx = np.array([[np.sin(angle)]]) + n * wavelength_um / geometry.period_um
    orders = Orders(kx, np.zeros((1, 1)), "te")
    medium = upper[-1].medium
    first = scatter(upper, 1.0, medium, orders, wave)
    silicon = complex(refractive_index("silicon", wavelength_um)) ** 2
    last = moved(scatter(lower, medium, silicon, orders, wave), geometry.shift, orders)
    falling = np.linalg.solve(np.eye(ORDERS) - first.below @ last.above, first.down)[0, :, ORDERS // 2]
    rising = last.above[0] @ falling
    q = admittance(medium, orders)[0][0]
    depth = 1j * wave * q * up_um[:, None]
    alive = -depth.real < DEEPEST
    down = np.where(alive, np.exp(np.where(alive, -depth, 0)) * falling, 0)
    total = down + np.exp(depth) * rising
    return np.abs(total @ np.exp(1j * wave * kx[0][:, None] * x_um)) ** 2
