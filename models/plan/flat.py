"""Tiles of which it is certain, before any capture, that the window comparison makes all their samples zero."""

import numpy as np
from numba import njit

from models.parameters import ELEMENTARY_CHARGE
from models.pixel.trim import gains, residual
from models.pixel.weights import view_weights

MARGIN = 1.0  # code: half for the rounding of the converter, half for that of the trim registers


def flat_tiles(scene, sensor, frame):
    """Bool (tile rows, tile cols). All False outside edge mode and with a threshold of at most MARGIN.

    The trimmed difference of a pixel is blind to the mean of its views: with weights c[v, u] = Wa - g Wb of sum 0
    and views between l and h, |difference| <= sum|c| (h - l) / 2. A full well breaks that balance, so no tile in
    which one may fill counts. Trim registers as the optics want them; noise and fixed pattern are not in the bound.
    """
    tile = sensor.tile
    shape = sensor.tile_rows, sensor.tile_cols
    if frame.mode != "edge" or frame.threshold <= MARGIN:
        return np.zeros(shape, bool)
    weights = view_weights(tile, sensor.optics)
    balance = gains(residual(weights))[:, None, None]
    reach = np.abs(weights[:, 0] - balance * weights[:, 1]).sum((1, 2)).max() / 2 * codes_per_unit(sensor, frame.timing)
    rows, cols = scene.shape
    span = np.zeros((2, shape[0] * tile.rows, shape[1] * tile.cols))
    _span(scene.light_field, span[:, :rows, :cols])
    spread, highest = span.reshape(2, shape[0], tile.rows, shape[1], tile.cols).max((2, 4))
    return (spread * reach <= frame.threshold - MARGIN) & (highest < _well_radiance(weights, sensor, frame))


def _well_radiance(weights, sensor, frame):
    """Radiance that fills no diode's well in an interval between common-mode resets, if nothing else is brighter.

    What a reset leaves behind is the difference: it adds up over the intervals.
    """
    e, seconds = sensor.electrical, frame.timing.t_int / sensor.chip.f_clk
    white = e.white_current * seconds / ELEMENTARY_CHARGE
    room = e.full_well - e.dark_current * seconds / ELEMENTARY_CHARGE * (frame.timing.n_cm + 1)
    return room / (white * weights.sum((2, 3)).max() * (frame.timing.n_cm + 1))


def codes_per_unit(sensor, timing):
    """Codes of the difference that a relative photocurrent of 1 makes, before gain mismatch and full wells."""
    e = sensor.electrical
    seconds = timing.t_int / sensor.chip.f_clk * (timing.n_cm + 1)
    return e.white_current * seconds / ELEMENTARY_CHARGE / e.lsb_electrons * e.difference_gain


@njit(cache=True)
def _span(light_field, out):
    """out[0, y, x] = largest minus smallest radiance over the views; out[1, y, x] = the largest."""
    views, _, rows, cols = light_field.shape
    for y in range(rows):
        low, high = light_field[0, 0, y].copy(), light_field[0, 0, y].copy()
        for v in range(views):
            for u in range(views):
                for x in range(cols):
                    low[x] = min(low[x], light_field[v, u, y, x])
                    high[x] = max(high[x], light_field[v, u, y, x])
        for x in range(cols):
            out[0, y, x] = high[x] - low[x]
            out[1, y, x] = high[x]
