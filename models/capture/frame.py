"""A scene through the pixels of one frame: the samples of the analog front end."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from models.parameters import ParameterError, SensorParameters
from models.pixel.polarization import transmission
from models.pixel.time_of_flight import TAPS, phase_of
from models.plan import Plan
from models.scene import Scene
from models.scene.depth_field import view_depths

from .expose import Exposure, expose
from .operator import CaptureOperator

Floats = npt.NDArray[np.floating]


def capture(
    scene: Scene,
    sensor: SensorParameters,
    plan: Plan,
    exposure: Exposure,
    balance: npt.ArrayLike | None = None,
    dtype: str = "float64",
) -> Floats:
    """Capture a scene.

    Parameters
    ----------
    scene : Scene
        Of the sensor's size.
    sensor : SensorParameters
        The sensor.
    plan : Plan
        Plan of the same scene and sensor.
    exposure : Exposure
        Times, electrical parameters and noise.
    balance : array (types,), optional
        Capacitor ratio g of every pixel type in the common-mode reset; None is 1.
    dtype : str
        'float32' or 'float64'.

    Returns
    -------
    array (taps, rows, cols, 2)
        Diode pairs in LSB of an 8-bit sum (see `expose`). Pixels that the plan does not read hold noise and offset
        alone.

    Raises
    ------
    ParameterError
        For a scene of another size, or time of flight of a scene without depth.
    """
    if scene.shape != (sensor.array.rows, sensor.array.cols):
        raise ParameterError(f"scene shape = {scene.shape}: must be ({sensor.array.rows}, {sensor.array.cols})")
    operator = CaptureOperator(sensor, dtype, plan.angular, plan.read)
    kinds = sensor.tile.type_map(*scene.shape)
    through = None
    if plan.polarized and scene.polarization is not None:
        gamma = np.array([t.gamma for t in sensor.tile.types])[kinds]
        through = transmission(scene.polarization, gamma, sensor.optics.diattenuation).astype(dtype)
    ratio = None if balance is None else np.asarray(balance, dtype)[kinds]

    samples = np.empty((plan.taps, *scene.shape, 2), dtype)
    for tap, pair in enumerate(currents(scene, operator, plan, sensor.electrical.f_mod)):
        samples[tap] = expose(pair if through is None else pair * through, exposure, ratio, tap)
    return samples


def currents(scene: Scene, operator: CaptureOperator, plan: Plan, f_mod: float) -> Iterator[Floats]:
    """Relative photocurrents of every tap in unpolarized light.

    Parameters
    ----------
    scene : Scene
        The scene.
    operator : CaptureOperator
        Of the plan's views and pixels.
    plan : Plan
        Number of taps and captures.
    f_mod : float
        Modulation frequency in Hz.

    Yields
    ------
    array (2, rows, cols)
        In the order of the taps.

    Raises
    ------
    ParameterError
        For time of flight of a scene without depth.

    References
    ----------
    [Jayasuriya2017], Eq. 5.2.
    """
    light = _views_read(scene, operator)
    if plan.taps == 1:
        yield operator.forward(light)
        return
    if scene.depth is None:
        raise ParameterError("depth = None: time of flight needs a scene with depth")
    if plan.captures == 1:
        pair = operator.forward(light)
        for tap in TAPS:
            yield _scaled(pair, float(1 + np.cos(tap + phase_of(scene.depth.flat[0], f_mod))) / 2)
    elif plan.captures == 3:
        mean = operator.forward(light)
        fields = modulated(light, scene.depth, scene.disparity, f_mod, (np.cos, np.sin))
        cosine, sine = (operator.forward(field) for field in fields)
        for part in (cosine, -sine, -cosine, sine):
            # A tap's current is never negative; mean and wave are rounded separately.
            yield np.maximum((mean + part) / 2, 0)
    else:
        for tap in TAPS:
            wave = [lambda p, t=tap: (1 + np.cos(t + p)) / 2]
            yield operator.forward(modulated(light, scene.depth, scene.disparity, f_mod, wave)[0])


def modulated(
    light: Floats,
    depth: Floats,
    disparity: Floats | None,
    f_mod: float,
    waves: Sequence[Callable[[npt.NDArray[np.float64]], npt.NDArray[np.float64]]],
) -> list[Floats]:
    """Light fields weighted by functions of the phase in each view.

    Parameters
    ----------
    light : array (views, views, rows, cols)
        l[v, u, y, x].
    depth : array (rows, cols)
        Depth of the centre view in m.
    disparity : array (rows, cols) or None
        Disparity of the centre view in px per view step.
    f_mod : float
        Modulation frequency in Hz.
    waves : sequence of callable
        Weights as functions of the phase in rad.

    Returns
    -------
    list of array (views, views, rows, cols)
        One per function.
    """
    out = [np.empty_like(light) for _ in waves]
    steps = np.arange(len(light), dtype=np.float64) - (len(light) - 1) / 2
    for v, u, there in view_depths(depth, disparity, steps):
        phase = phase_of(there, f_mod)
        for field, wave in zip(out, waves, strict=True):
            np.multiply(light[v, u], wave(phase), out=field[v, u], casting="same_kind")
    return out


def _views_read(scene: Scene, operator: CaptureOperator) -> Floats:
    """Light field of the scene in the operator's type and with its number of views."""
    light = scene.light_field if not operator.angular else scene.full_light_field
    return np.ascontiguousarray(light, operator.dtype)


def _scaled(pair: Floats, factor: float) -> Floats:
    return pair * pair.dtype.type(factor)
