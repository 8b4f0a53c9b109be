"""The reset pointer of the whole chip in the frame bench: the bytes, and how long each row of pixels integrates."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.imaging.frame import hardware
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.request import request
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.digital.exposure import integration_cycles
from talbot.models.parameters import (
    MODES,
    STANDARD,
    AmpTiming,
    ArrayParameters,
    ChipParameters,
    FrameParameters,
    RoomParameters,
    SensorParameters,
    Window,
    circuit_columns,
)
from talbot.models.plan.exposure import fitting

SENSOR = SensorParameters(array=ArrayParameters(13, 50), chip=ChipParameters(lanes=4))
SHORT = AmpTiming(t_reset=2, t_int=3, t_cm=2, t_settle=2, t_read=2, t_guard=1, n_cm=2)
FRAMES = {
    "edge": FrameParameters(SENSOR.full_window, threshold=9),
    "every sample": FrameParameters(SENSOR.full_window, threshold=0, overlap=False),
    "image, some types": FrameParameters(SENSOR.full_window, "image", mask=0x8040A1),
    "raw, a window": FrameParameters(Window(1, 2, 1, 2), "raw"),
    "edge, decimated": FrameParameters(SENSOR.full_window, mask=0x00F0FF, decimation=1),
    "tof": FrameParameters(SENSOR.full_window, "tof", mask=0x0F),
    "phase": FrameParameters(Window(1, 1, 0, 2), "tof", phase=True),
}


@pytest.fixture(scope="module")
def program():
    return hardware.program(SENSOR)


def run(program, frame, stall=0):
    """(chip's frame, golden frame, cycles of each row that is read) of samples that no exposure made."""
    rng = np.random.default_rng(3)
    samples = rng.uniform(0, 128, (4, *SENSOR.shape, 1)) + rng.normal(0, 20, (4, *SENSOR.shape, 2))
    front_end = front_end_of(SENSOR, range(24))
    chip = hardware.simulate(program, SENSOR, frame, samples, front_end, stall=stall)
    golden = golden_frame(samples, SENSOR, frame, front_end)
    return chip, golden, {chip.integrated[row] for row in np.flatnonzero(golden.read.any(1))}


@pytest.mark.parametrize("exposure", [0, 1, 4, 8, 30])
@pytest.mark.parametrize("name", FRAMES)
def test_bytes_and_integration_at_the_pins(program, name, exposure):
    """The pointer at none, one, half and all rows of the array, and beyond."""
    frame = FRAMES[name]
    frame = replace(frame, timing=replace(SHORT, exposure=exposure))
    frame = replace(frame, timing=fitting(frame, SENSOR))
    chip, golden, integrated = run(program, frame)
    assert chip.stream == golden.stream
    assert integrated == {sum(integration_cycles(frame.exposing))}


def test_rows_behind_a_row_that_waits_integrate_longer(program):
    """A stalled link changes no byte, and is seen in the integration."""
    frame = replace(FRAMES["edge"], timing=replace(SHORT, exposure=4))
    frame = replace(frame, timing=fitting(frame, SENSOR))
    chip, golden, integrated = run(program, frame, stall=250)
    assert chip.stream == golden.stream
    assert max(integrated) > sum(integration_cycles(frame.timing)) == min(integrated)


def test_the_light_is_the_room_s_and_the_sensor_stays_what_it_is():
    asked = request(lux=100.0)
    assert asked.sensor == STANDARD and asked.room == RoomParameters(illuminance=100.0)
    assert asked.lit == asked.room.lit(STANDARD) != STANDARD
    assert request(mode="tof").lit == STANDARD


@pytest.mark.parametrize(
    "given, timing",
    [
        ({"exposure": 0}, AmpTiming()),
        ({"exposure": 7}, AmpTiming(exposure=7)),
        ({"exposure": 7, "timing": {"t_int": 300}}, AmpTiming(t_int=300, exposure=7)),
        ({"timing": {"t_int": 300}}, AmpTiming(t_int=300)),
        ({"mode": "tof"}, AmpTiming()),
        ({"mode": "tof", "exposure": 7}, AmpTiming(exposure=7)),
    ],
)
def test_what_is_given_stays(given, timing):
    assert request(**given).frame.timing == timing


def test_other_phases_leave_the_exposure_to_the_light():
    dim, timing = (request(**given).frame.timing for given in ({"lux": 250.0}, {"timing": {"t_settle": 40}}))
    usual = request().frame.timing.exposure
    assert 0 < timing.exposure < usual < dim.exposure and timing.t_settle == 40


@pytest.mark.parametrize("mode", MODES)
def test_the_circuits_columns_give_what_was_measured_of_them(mode):
    """The front end has a column's curves of the same charges."""
    columns = circuit_columns()
    plain, own = (
        golden_result(request(24, 36, mode=mode, noise=0.0, columns=of)).exposed.samples for of in (None, columns)
    )
    assert own == pytest.approx(columns.samples(plain, mode)) and (own != plain).any()
