"""A scene through the pixels of one frame: what the analog front end will sample."""

import numpy as np

from models.parameters import ParameterError
from models.pixel.polarization import transmission
from models.pixel.time_of_flight import TAPS, phase_of
from models.scene.depth_field import view_depths

from .expose import expose
from .operator import CaptureOperator


def capture(scene, sensor, plan, exposure, balance=None, dtype="float64"):
    """Samples of a frame, (taps, rows, cols, 2): diode pairs in LSB of an 8-bit sum (see `expose`).

    plan: of models.plan, of the same scene and sensor. exposure: an Exposure. balance: g of every pixel type,
    (types,), for the common-mode reset, or None. dtype: 'float32' or 'float64'. Pixels that the plan does not read
    hold noise and offset alone.
    """
    if scene.shape != (sensor.array.rows, sensor.array.cols):
        raise ParameterError(f"scene shape = {scene.shape}: must be ({sensor.array.rows}, {sensor.array.cols})")
    operator = CaptureOperator(sensor, dtype, plan.angular, plan.read)
    kinds = sensor.tile.type_map(*scene.shape)
    through = None
    if plan.polarized:
        gamma = np.array([t.gamma for t in sensor.tile.types])[kinds]
        through = transmission(scene.polarization, gamma, sensor.optics.diattenuation).astype(dtype)
    ratio = None if balance is None else np.asarray(balance, dtype)[kinds]

    samples = np.empty((plan.taps, *scene.shape, 2), dtype)
    for tap, pair in enumerate(currents(scene, operator, plan, sensor.electrical.f_mod)):
        samples[tap] = expose(pair if through is None else pair * through, exposure, ratio, tap)
    return samples


def currents(scene, operator, plan, f_mod):
    """Relative photocurrents (2, rows, cols) of every tap, in order, unpolarized: yields them."""
    light = _views_read(scene, operator)
    if plan.taps == 1:
        yield operator.forward(light)
        return
    if scene.depth is None:
        raise ParameterError("depth = None: time of flight needs a scene with depth")
    if plan.captures == 1:
        pair = operator.forward(light)
        for tap in TAPS:
            yield _scaled(pair, (1 + np.cos(tap + phase_of(scene.depth.flat[0], f_mod))) / 2)
    elif plan.captures == 3:
        mean = operator.forward(light)
        cosine, sine = (operator.forward(field) for field in modulated(light, scene, f_mod, (np.cos, np.sin)))
        for part in (cosine, -sine, -cosine, sine):
            # A tap's current is never negative; mean and wave are rounded apart.
            yield np.maximum((mean + part) / 2, 0)
    else:
        for tap in TAPS:
            yield operator.forward(modulated(light, scene, f_mod, [lambda p, t=tap: (1 + np.cos(t + p)) / 2])[0])


def modulated(light, scene, f_mod, waves):
    """The light field times each of ``waves``, functions of the phase (rad) that each view sees: new arrays."""
    out = [np.empty_like(light) for _ in waves]
    steps = np.arange(len(light)) - (len(light) - 1) / 2
    for v, u, depth in view_depths(scene, steps):
        phase = phase_of(depth, f_mod)
        for field, wave in zip(out, waves, strict=True):
            np.multiply(light[v, u], wave(phase), out=field[v, u], casting="same_kind")
    return out


def _views_read(scene, operator):
    """The scene's light field in the operator's type and with as many views."""
    light = scene.light_field if not operator.angular else scene.full_light_field
    return np.ascontiguousarray(light, operator.dtype)


def _scaled(pair, factor):
    return pair * pair.dtype.type(factor)
