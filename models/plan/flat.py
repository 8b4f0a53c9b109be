"""Tiles whose samples are all certain, before any capture, to be set to zero by the window comparison."""

import numpy as np
import numpy.typing as npt
from numba import njit

from models.parameters import ELEMENTARY_CHARGE, AmpTiming, FrameParameters, SensorParameters
from models.pixel.trim import gains, residual
from models.pixel.weights import view_weights
from models.scene import Scene

MARGIN = 1.0  # code: half for the rounding of the converter, half for that of the trim registers


def flat_tiles(scene: Scene, sensor: SensorParameters, frame: FrameParameters) -> npt.NDArray[np.bool_]:
    """Tiles in which no sample can reach the threshold.

    The trimmed difference of a pixel does not depend on the mean of its views: with weights c[v, u] = Wa - g Wb of
    sum 0 and views between l and h, |difference| <= sum|c| (h - l) / 2. A full well breaks that balance, so that tiles
    in which one may fill do not count. The trim registers follow the optics; the bound has no noise and no fixed
    pattern.

    Parameters
    ----------
    scene : Scene
        Of the sensor's size.
    sensor : SensorParameters
        The sensor.
    frame : FrameParameters
        Configuration of the frame.

    Returns
    -------
    bool (tile rows, tile cols)
        All False outside edge mode and with a threshold of at most MARGIN.
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


def _well_radiance(weights: npt.NDArray[np.float64], sensor: SensorParameters, frame: FrameParameters) -> float:
    """Largest radiance of a scene that fills no well between common-mode resets.

    A reset leaves the difference, which adds up over the intervals.
    """
    e, seconds = sensor.electrical, frame.timing.t_int / sensor.chip.f_clk
    white = e.white_current * seconds / ELEMENTARY_CHARGE
    room = e.full_well - e.dark_current * seconds / ELEMENTARY_CHARGE * (frame.timing.n_cm + 1)
    return room / (white * weights.sum((2, 3)).max() * (frame.timing.n_cm + 1))


def codes_per_unit(sensor: SensorParameters, timing: AmpTiming) -> float:
    """Codes of the difference per relative photocurrent, before gain mismatch and full wells.

    Parameters
    ----------
    sensor : SensorParameters
        The sensor.
    timing : AmpTiming
        Integration time and common-mode resets.

    Returns
    -------
    float
        Codes per unit.
    """
    e = sensor.electrical
    seconds = timing.t_int / sensor.chip.f_clk * (timing.n_cm + 1)
    return e.white_current * seconds / ELEMENTARY_CHARGE / e.lsb_electrons * e.difference_gain


@njit(cache=True)
def _span(light_field: npt.NDArray[np.floating], out: npt.NDArray[np.float64]) -> None:
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
