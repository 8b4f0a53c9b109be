"""A scene through the pixels of one frame: the samples of the analog front end."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from talbot.models.capture.expose import Exposure, expose, full_wells
from talbot.models.capture.pupil import Region, Wave, integrate
from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.pixel.polarization import transmission
from talbot.models.pixel.time_of_flight import phase_of, tap_functions
from talbot.models.plan import Plan
from talbot.models.scene import Scene
from talbot.models.scene.depth_field import depth_of_surface
from talbot.models.scene.echo import Correlation

Floats = npt.NDArray[np.floating]


def capture(
    scene: Scene,
    sensor: SensorParameters,
    plan: Plan,
    exposure: Exposure,
    balance: npt.ArrayLike | None = None,
    regions: Sequence[Region] | None = None,
) -> Floats:
    """Capture a scene: `currents`, then `exposed`.

    scene: of the sensor's size. sensor: the sensor. plan: plan of the same scene and sensor. exposure: times,
    electrical parameters and noise. balance: (types,), capacitor ratio g of every pixel type in the common-mode reset;
    None is 1. regions: as in `currents`. Returns (taps, rows, cols, 2), diode pairs in LSB of an 8-bit sum (see
    `expose`). Pixels that the plan does not read hold noise and offset alone. Raises ParameterError for a scene of
    another size, or time of flight of a scene without depth.
    """
    return exposed(currents(scene, sensor, plan, regions), sensor, exposure, balance)


def exposed(
    pairs: Floats, sensor: SensorParameters, exposure: Exposure, balance: npt.ArrayLike | None = None
) -> Floats:
    """Expose the photocurrents of a frame.

    pairs: (taps, 2, rows, cols), photocurrents of every tap. sensor: the sensor. exposure: times, electrical parameters
    and noise. balance: (types,), capacitor ratio g of every pixel type in the common-mode reset; None is 1. Returns
    (taps, rows, cols, 2), as in `capture`.
    """
    ratio = _ratio(pairs, sensor, balance)
    return np.stack([expose(pair, exposure, ratio, tap) for tap, pair in enumerate(pairs)])


def full_pixels(
    pairs: Floats, sensor: SensorParameters, exposure: Exposure, balance: npt.ArrayLike | None = None
) -> npt.NDArray[np.bool_]:
    """Tell the pixels that have a full well in any tap of a frame.

    pairs, sensor, exposure, balance: as in `exposed`. Returns (rows, cols), as of `full_wells`.
    """
    ratio = _ratio(pairs, sensor, balance)
    return np.any([full_wells(pair, exposure, ratio) for pair in pairs], axis=0)


def _ratio(pairs: Floats, sensor: SensorParameters, balance: npt.ArrayLike | None) -> Floats | None:
    """Capacitor ratio of every pixel, (rows, cols), from those of the types."""
    if balance is None:
        return None
    return np.asarray(balance, pairs.dtype)[sensor.tile.type_map(*pairs.shape[2:])]


def currents(scene: Scene, sensor: SensorParameters, plan: Plan, regions: Sequence[Region] | None = None) -> Floats:
    """Relative photocurrents of every tap.

    scene: of the sensor's size. sensor: the sensor. plan: plan of the same scene and sensor. regions: views of which
    pixels (models.capture.choose_views); None is the scene's own grid everywhere. Returns (taps, 2, rows, cols), in the
    order of the taps; 0 at pixels that the plan does not read. Raises ParameterError for a scene of another size, or
    time of flight of a scene without depth. Source: [Jayasuriya2017], Eq. 5.2.
    """
    if scene.shape != (sensor.array.rows, sensor.array.cols):
        raise ParameterError(f"scene shape = {scene.shape}: must be ({sensor.array.rows}, {sensor.array.cols})")
    if regions is None:
        regions = [Region(scene.views if plan.angular else 1, np.ones(scene.shape, bool))]
    out = np.zeros((plan.taps, 2, *scene.shape))
    for region in regions:
        read = region.pixels & plan.read
        if read.any():
            out += _taps(scene, sensor, plan, Region(region.views, read))
    if plan.polarized and not _by_view(scene, plan):
        out *= transmission(scene.seen_polarization, _gratings(sensor), sensor.optics.diattenuation)
    return out


def _by_view(scene: Scene, plan: Plan) -> bool:
    """Return whether polarization differs between views; the taps of time of flight take that of the centre view."""
    return plan.polarized and plan.taps == 1 and scene.polarization is not None and scene.polarization.ndim == 5


def _gratings(sensor: SensorParameters) -> Floats:
    """Orientation of every pixel's grating in rad, (rows, cols)."""
    return np.array([t.gamma for t in sensor.tile.types])[sensor.tile.type_map(*sensor.shape)]


def _polarized(scene: Scene, sensor: SensorParameters, region: Region) -> Floats:
    """Photocurrents of light whose polarization differs between the views, (1, 2, rows, cols)."""
    stokes, middle = np.asarray(scene.polarization), scene.views // 2
    waves = [None, *(lambda s, dv, du, p=part: p[round(dv) + middle, round(du) + middle] for part in stokes)]
    total, s1, s2 = integrate(scene, sensor, region, waves)
    turn = 2 * _gratings(sensor)
    passed = total - sensor.optics.diattenuation * (np.cos(turn) * s1 + np.sin(turn) * s2)
    return np.maximum(passed, 0)[None]


def _taps(scene: Scene, sensor: SensorParameters, plan: Plan, region: Region) -> Floats:
    """Photocurrents of every tap in one region, (taps, 2, rows, cols), 0 outside."""
    if _by_view(scene, plan):
        return _polarized(scene, sensor, region)
    if plan.taps == 1:
        return integrate(scene, sensor, region)
    if scene.depth is None:
        raise ParameterError("depth = None: time of flight needs a scene with depth")
    e = sensor.electrical
    taps = tap_functions(e)
    if plan.captures == 1:
        pair = integrate(scene, sensor, region)[0]
        return np.stack([pair * pair.dtype.type(tap(scene.depth.flat[0])) for tap in taps])
    if plan.captures == 3:
        parts = [_returned(scene, lambda z, w=wave: w(phase_of(z, e.f_mod))) for wave in (np.cos, np.sin)]
        mean, *parts = integrate(scene, sensor, region, [None, *parts])
        cosine, sine = (part * mean.dtype.type(e.contrast) for part in parts)
        mean *= mean.dtype.type(1 + 2 * e.ambient)
        # A tap's current is never negative; mean and wave are rounded separately.
        return np.stack([np.maximum((mean + part) / 2, 0) for part in (cosine, -sine, -cosine, sine)])
    return integrate(scene, sensor, region, [_returned(scene, tap) for tap in taps])


def _returned(scene: Scene, correlation: Correlation) -> Wave:
    """Return the correlation of the light of a view, direct or with echoes."""
    assert scene.depth is not None
    depth = depth_of_surface(scene.depth, scene.disparity)
    if scene.echo is None:
        return lambda surface, dv, du: correlation(depth(surface))
    returned = scene.echo.returned(correlation)
    return lambda surface, dv, du: returned(depth(surface), surface, dv, du)
