"""The number of views that a capture needs, measured in advance on tile rows spread evenly over the array."""

from time import perf_counter
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.capture.moving import moving_currents
from talbot.models.capture.pupil import Region, cells, integrate
from talbot.models.parameters import AmpTiming, ParameterError, SensorParameters, check_int, check_real
from talbot.models.pixel.trim import optical_gains
from talbot.models.plan import LeftOut, Plan, codes_per_unit
from talbot.models.scene import Sampling, Scene
from talbot.models.scene.views import Pictured, Shifted

Values = npt.NDArray[np.float64]

REFERENCE = 31  # views along the pupil's diameter that the error is measured against
LADDER = (7, 9, 11, 15, 21, 27)
BOUND = 0.5  # codes
SAFETY = 0.8  # of the bound, for the rows that are not measured and the rounding of the trims
PROBE = 24  # tile rows that are measured at most


class Views(NamedTuple):
    """Views of a capture.

    regions: which pixels need how many.
    most: views along the pupil's diameter where most are needed.
    error: of the quadrature: RMS error of the differences against REFERENCE views in codes, where they are measured;
        None where the scene has no other views than its own.
    left_out: views that are not rendered.
    tried: views, their RMS error in codes and their time in s, where they are measured.
    hidden: RMS in codes, there, by which the differences of the middle view and its disparity are off: light that other
        views show and the middle view does not. None where the scene does not know that light.
    """

    regions: tuple[Region, ...]
    most: int
    error: float | None
    left_out: tuple[LeftOut, ...] = ()
    tried: tuple[tuple[int, float, float], ...] = ()
    hidden: float | None = None


def choose_views(
    scene: Scene, sensor: SensorParameters, timing: AmpTiming, views: int | None = None, bound: float = BOUND
) -> Views:
    """Choose the views of a capture.

    The differences are captured through REFERENCE views and through ever more of them, until the error is below the
    bound: in PROBE tile rows spread evenly over the array, or in all. Tiles whose light varies least over the pupil
    keep the scene's own grid, as many as the error allows: regions in focus, and plain ones. Mask, window and
    decimation of the frame play no part: leaving pixels out changes no bit of the others.

    scene: of the sensor's size. sensor: the sensor. timing: integration time, which makes codes of photocurrents.
    views: along the pupil's diameter everywhere, 1..31; None chooses. bound: largest RMS error in codes, 0.01..100.
    Returns Views: their number, where, and the error. Raises ParameterError for views or a bound out of range, or other
    views than those of a light field.
    """
    check_real("bound", bound, 0.01, 100)
    everywhere = np.ones(scene.shape, bool)
    if views is not None:
        check_int("views", views, 1, REFERENCE)
    if not scene.angular:
        return Views((Region(1, everywhere),), 1, 0.0)
    if scene.render is None:
        if views not in (None, scene.views):
            raise ParameterError(f"views = {views}: must be left out, the light field has its own {scene.views}")
        return Views((Region(scene.views, everywhere),), scene.views, None)
    probe = _Probe(scene, sensor, timing)
    if views is not None:
        error = probe.error(views)
        hidden = probe.hidden(views, error)
        return Views((Region(views, everywhere),), views, _rms(error), (), tuple(probe.tried), hidden)
    grid, goal = probe.error(scene.views), (SAFETY * bound) ** 2
    if _rms(grid) ** 2 <= goal:
        saved = _saved(scene, everywhere, scene.views)
        hidden = probe.hidden(scene.views, grid)
        return Views((Region(scene.views, everywhere),), scene.views, _rms(grid), saved, tuple(probe.tried), hidden)
    spans = _spans(scene, sensor)
    order = np.argsort(spans[probe.pixels], kind="stable")
    most, error = REFERENCE, np.zeros_like(grid)
    for most in (*(n for n in LADDER if n > scene.views), REFERENCE):
        error = probe.error(most)
        if _rms(error) ** 2 <= goal:
            break
    # Mean square with the pixels of least span on the scene's grid, up to each; tiles of one span go together.
    rising = spans[probe.pixels][order]
    mean = (np.cumsum((grid**2)[order]) + np.sum(error**2) - np.cumsum((error**2)[order])) / grid.size
    few = np.flatnonzero((mean <= goal) & (rising != np.append(rising[1:], np.inf)))
    quiet = spans <= (rising[few[-1]] if few.size else -1.0)
    rms = _rms(np.where(quiet[probe.pixels], grid, error))
    regions = tuple(r for r in (Region(scene.views, quiet), Region(most, ~quiet)) if r.pixels.any())
    return Views(regions, most, rms, _saved(scene, quiet, most), tuple(probe.tried), probe.hidden(most, error))


def captured(
    scene: Scene, sensor: SensorParameters, plan: Plan, timing: AmpTiming, views: int | None = None
) -> tuple[Views, npt.NDArray[np.floating]]:
    """Choose the views of a capture and capture the scene through them.

    scene: of the sensor's size. sensor: the sensor. plan: plan of the same scene and sensor. timing: of the frame as it
    exposes. views: as in `choose_views`. Returns Views: as of `choose_views`. Returns (taps, 2, rows, cols), as of
    `moving_currents`. Raises ParameterError as both.
    """
    chosen = choose_views(scene, sensor, timing, views)
    return chosen, moving_currents(scene, sensor, plan, timing, regions=chosen.regions)


class _Probe:
    """Differences against those through REFERENCE views, where they are measured."""

    def __init__(self, scene: Scene, sensor: SensorParameters, timing: AmpTiming) -> None:
        self.scene, self.sensor = scene, sensor
        count = min(PROBE, sensor.tile_rows)
        measured = ((np.arange(count) + 0.5) * sensor.tile_rows / count).astype(int)
        rows = np.isin(np.arange(scene.shape[0]) // sensor.tile.rows, measured)
        self.pixels = np.broadcast_to(rows[:, None], scene.shape)
        self.unit = codes_per_unit(sensor, timing)
        gains = optical_gains(sensor.tile, sensor.optics)
        self.gains = gains[sensor.tile.type_map(*scene.shape)][self.pixels]
        self.tried: list[tuple[int, float, float]] = []
        self.reference = self._differences(scene, REFERENCE)

    def error(self, views: int) -> Values:
        """Error of a number of views in codes, (pixels,)."""
        start = perf_counter()
        error = self._differences(self.scene, views) - self.reference
        self.tried.append((views, _rms(error), perf_counter() - start))
        return error

    def hidden(self, views: int, error: Values) -> float | None:
        """RMS of `Views.hidden` through as many views as have this error; None where the scene does not know it."""
        scene = self.scene
        if not callable(scene.render) or isinstance(scene.render, Pictured | Shifted) or scene.disparity is None:
            return None
        image, disparity = np.asarray(scene.image, float), np.asarray(scene.disparity, float)
        alone = Pictured(image, disparity, Sampling.of(self.sensor))
        visible = Scene(scene.name, scene.views, None, scene.image, scene.disparity, render=alone)
        return _rms(self._differences(visible, views) - self.reference - error)

    def _differences(self, scene: Scene, views: int) -> Values:
        a, b = integrate(scene, self.sensor, Region(views, self.pixels))[0][:, self.pixels]
        return self.unit * (a - self.gains * b)


def _spans(scene: Scene, sensor: SensorParameters) -> Values:
    """Largest minus smallest radiance over the light field's views, RMS over each tile, at every pixel."""
    low, high = (function(scene.light_field, (0, 1)) for function in (np.min, np.max))
    (rows, cols), tile = scene.shape, sensor.tile
    padded = np.zeros((2, sensor.tile_rows * tile.rows, sensor.tile_cols * tile.cols))
    padded[0, :rows, :cols], padded[1, :rows, :cols] = (high - low) ** 2, 1
    total, count = padded.reshape(2, sensor.tile_rows, tile.rows, sensor.tile_cols, tile.cols).sum((2, 4))
    return np.kron(np.sqrt(total / count), np.ones((tile.rows, tile.cols)))[:rows, :cols]


def _rms(error: Values) -> float:
    return float(np.sqrt(np.mean(error**2)))


def _saved(scene: Scene, quiet: npt.NDArray[np.bool_], most: int) -> tuple[LeftOut, ...]:
    """Return the views that pixels on the scene's grid leave out."""
    full, default_views = int(cells(most).sum()), int(cells(scene.views).sum())
    if most == scene.views:
        full, why = int(cells(REFERENCE).sum()), "the light varies little over the pupil everywhere: in focus, or plain"
    else:
        why = "where the light varies little over the pupil: in focus, or plain"
    if not quiet.any():
        return ()
    share = 100 * quiet.mean()
    return (
        LeftOut("views of quiet tiles", why, f"{full - default_views} of {full} views of {share:.0f} % of the pixels"),
    )
