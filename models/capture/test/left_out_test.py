"""What the plan leaves out changes no sample (or less than a stated bound) and does save the work."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from talbot.models.capture import Exposure, capture, captured, exposed
from talbot.models.capture.operator import rounding
from talbot.models.parameters import (
    ALL_TYPES,
    ArrayParameters,
    FrameParameters,
    ParameterError,
    SensorParameters,
    Window,
)
from talbot.models.pixel import demodulate, depth_of, phase_of
from talbot.models.plan import plan
from talbot.models.scene import Sampling, Scene, load
from talbot.models.scene.test.focused import focused

ROWS, COLS = 38, 62
SENSOR = SensorParameters(array=ArrayParameters(ROWS, COLS))
FULL = SENSOR.full_window


def _scene(name, **sampling):
    return load(name, Sampling(ROWS, COLS, **sampling))


def _samples(scene, made, frame, noise=1.0):
    return capture(scene, SENSOR, made, Exposure(SENSOR.electrical, frame.timing, SENSOR.chip.f_clk, noise))


def _what(made):
    return {entry.what for entry in made.left_out}


@pytest.mark.parametrize(
    "mask,window", [(0x000F00, FULL), (1 << 5, FULL), (0xFFFFFF, Window(2, 4, 3, 3)), (0xF0F0F0, Window(9, 9, 0, 10))]
)
@pytest.mark.parametrize("mode", ["edge", "tof"])
def test_unread_pixels(mask, window, mode):
    frame = FrameParameters(window, mode=mode, mask=mask)
    scene = _scene("motorcycle")
    made = plan(scene, SENSOR, frame)
    everything = replace(made, read=np.ones_like(made.read))
    assert 0 < made.read.sum() < ROWS * COLS and "unread pixels" in _what(made)
    part, whole = _samples(scene, made, frame), _samples(scene, everything, frame)
    np.testing.assert_array_equal(part[:, made.read], whole[:, made.read])


@cache
def _chosen(mode):
    """Samples of every pixel through the views that are chosen."""
    return _through_chosen(FrameParameters(FULL, mode=mode))


def _through_chosen(frame):
    scene = _scene("motorcycle")
    todo = plan(scene, SENSOR, frame)
    views, pairs = captured(scene, SENSOR, todo, frame.exposing)
    assert len({region.views for region in views.regions} | {scene.views}) > 1  # not the scene's own grid alone
    return todo.read, exposed(pairs, SENSOR, Exposure(SENSOR.electrical, frame.exposing, SENSOR.chip.f_clk))


@settings(max_examples=5, deadline=None)
@given(st.data())
def test_mask_window_and_decimation_change_no_sample(draw):
    rows, cols = (sorted(draw.draw(st.tuples(*2 * (st.integers(0, n - 1),)))) for n in (10, 11))
    mode, mask = draw.draw(st.sampled_from(["edge", "raw"])), draw.draw(st.integers(1, ALL_TYPES))
    frame = FrameParameters(Window(*rows, *cols), mode=mode, mask=mask, decimation=draw.draw(st.integers(0, 3)))
    try:
        read, samples = _through_chosen(frame)
    except ParameterError:  # selects no pixel
        reject()
    np.testing.assert_array_equal(samples[:, read], _chosen(mode)[1][:, read])


def test_one_view_where_there_is_no_angle():
    frame = FrameParameters(FULL)
    few = load("coins", focused(Sampling(ROWS, COLS), 0.0))
    made = plan(few, SENSOR, frame)
    assert not made.angular and "views" in _what(made)
    many = Scene("copies", 5, np.ascontiguousarray(few.full_light_field), few.image)
    assert plan(many, SENSOR, frame).angular
    a, b = _samples(few, made, frame, noise=0), _samples(many, plan(many, SENSOR, frame), frame, noise=0)
    assert np.abs(a - b).max() <= rounding("float64", 5) * a.max()


def test_unpolarized_light_needs_no_factor():
    frame = FrameParameters(FULL)
    plain = _scene("motorcycle")
    zero = replace(plain, polarization=np.zeros((2, ROWS, COLS)))
    made = [plan(s, SENSOR, frame) for s in (plain, zero)]
    assert "polarization" in _what(made[0]) and made[1].polarized
    np.testing.assert_array_equal(_samples(plain, made[0], frame), _samples(zero, made[1], frame))


def test_polarization_reaches_the_samples():
    frame = FrameParameters(FULL)
    scene = _scene("polarized:100")
    samples = _samples(scene, plan(scene, SENSOR, frame), frame, noise=0)[0].sum(-1)
    kinds = SENSOR.tile.type_map(ROWS, COLS)
    ratio = samples[kinds == 2].mean() / samples[kinds == 0].mean()  # gamma 90 against 0, all psi alike
    assert samples[kinds == 0].std() > 10 and abs(ratio - 1) < 0.1


@pytest.mark.parametrize("name,captures", [("coins", 1), ("motorcycle", 3), ("tilted", 3)])
def test_taps_of_a_static_scene(name, captures):
    frame = FrameParameters(FULL, mode="tof")
    scene = _scene(name)
    short = plan(scene, SENSOR, frame)
    long = plan(replace(scene, static=False), SENSOR, frame)
    assert (short.captures, long.captures) == (captures, 4)
    a, b = _samples(scene, short, frame, noise=0), _samples(scene, long, frame, noise=0)
    assert a.shape == (4, ROWS, COLS, 2)
    # Sums of views**2 terms, rounded in another order, of a mean and a wave of up to its size; and phases, rounded.
    phase = phase_of(scene.depth.max(), SENSOR.electrical.f_mod)
    assert np.abs(a - b).max() <= (4 * rounding("float64", 5) + phase * np.finfo(float).eps) * 255


def test_taps_give_the_depth_back():
    scene, frame = _scene("motorcycle"), FrameParameters(FULL, mode="tof")
    taps = _samples(scene, plan(scene, SENSOR, frame), frame, noise=0).sum(-1)
    error = depth_of(demodulate(taps)[0], SENSOR.electrical.f_mod) - scene.depth
    assert np.median(np.abs(error)) < 0.01
