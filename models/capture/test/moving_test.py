"""A rolling shutter before a moving edge: skew is the time between rows, blur the time that a row integrates."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from talbot.models.capture import currents, moving_currents
from talbot.models.digital.exposure import integration_cycles, slot_cycles, windows
from talbot.models.parameters import (
    AmpTiming,
    ArrayParameters,
    CameraParameters,
    FrameParameters,
    OpticsParameters,
    ParameterError,
    SensorParameters,
)
from talbot.models.plan import plan
from talbot.models.scene import Sampling, load

# A small pupil: the edge is as sharp as it is drawn
SENSOR = SensorParameters(array=ArrayParameters(40, 120), optics=OpticsParameters(camera=CameraParameters(f_number=32)))
TIMING = AmpTiming(t_int=500, exposure=12)


def seen(speed, timing=TIMING, sensor=SENSOR, **frame):
    """Sum of every pair, (rows, cols), the scene and its plan."""
    scene = load(f"moving:{speed}", Sampling.of(sensor))
    asked = FrameParameters(sensor.full_window, "image", timing=timing, **frame)
    work = plan(scene, sensor, asked)
    return moving_currents(scene, sensor, work, timing)[0].sum(0), scene, work


def places(image):
    """Position of the edge in every row, px: how much of the row is dark."""
    return _dark(image).sum(1)


def _dark(image):
    """1 on the dark side of the edge, 0 on the bright one, (rows, cols)."""
    return (0.95 - np.clip(0.95 * image / flat_of(SENSOR), 0, 1)) / 0.9


@cache
def flat_of(sensor):
    """The same sensor before white, times 0.95: what the bright side gives."""
    scene = load("flat:95", Sampling.of(sensor))
    asked = FrameParameters(sensor.full_window, "image")
    return currents(scene, sensor, plan(scene, sensor, asked))[0].sum(0)


@pytest.mark.parametrize("speed, exposure", [(4000, 12), (9000, 0), (-0.0, 12), (3000, 39)])
def test_skew_is_the_time_between_rows(speed, exposure):
    timing = replace(TIMING, exposure=exposure)
    image, *_ = seen(speed, timing)
    place = places(image)
    f = SENSOR.chip.f_clk
    starts, span = windows(timing, SENSOR.array.rows)
    middle = (np.array(starts) + span / 2) / f
    expected = SENSOR.array.cols / 2 - SENSOR.array.cols / 4 + speed * middle
    assert np.abs(place - expected).max() < 0.3
    slope = np.polyfit(np.arange(SENSOR.array.rows), place, 1)[0]
    assert slope == pytest.approx(speed * slot_cycles(timing) / f, abs=0.01)


def test_blur_is_the_time_that_a_row_integrates():
    widths = []
    for exposure in (0, 20):
        timing = replace(TIMING, exposure=exposure)
        image, *_ = seen(8000, timing)
        dark = _dark(image)[20]
        widths.append(((dark > 0.02) & (dark < 0.98)).sum())
    longer = 8000 * (sum(integration_cycles(replace(TIMING, exposure=20))) - TIMING.t_int) / SENSOR.chip.f_clk
    assert widths[1] - widths[0] == pytest.approx(longer, abs=2)


def test_rows_that_are_not_read_take_no_time():
    """With one row of four masked out of the tile, the next row that is read is a slot later, not two."""
    order = SENSOR.tile.order
    mask = sum(1 << kind for row in (0, 2, 3) for kind in order[6 * row : 6 * row + 6])
    image, _, work = seen(4000, mask=mask)
    rows = np.flatnonzero(work.read.any(1))
    place = places(image)
    slopes = np.diff(place[rows])
    assert slopes == pytest.approx(np.full(len(rows) - 1, 4000 * slot_cycles(TIMING) / SENSOR.chip.f_clk), abs=0.2)
    assert not image[~work.read].any()


def test_a_scene_that_stands_still_is_captured_once():
    image, scene, work = seen(0)
    assert (image == currents(scene, SENSOR, work)[0].sum(0)).all()


def test_refused():
    scene = load("moving:1e6", Sampling.of(SENSOR))
    work = plan(scene, SENSOR, FrameParameters(SENSOR.full_window, "image"))
    with pytest.raises(ParameterError, match="scene travel = .* px a frame: must be at most 1000"):
        moving_currents(scene, SENSOR, work, replace(TIMING, exposure=1023))
    work = plan(scene, SENSOR, FrameParameters(SENSOR.full_window, "tof"))
    with pytest.raises(ParameterError, match="must not move in time of flight"):
        moving_currents(scene, SENSOR, work, TIMING)
