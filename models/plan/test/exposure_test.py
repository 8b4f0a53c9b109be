"""The timing that light asks for, and the chain from lux to electrons."""

from dataclasses import replace

import pytest

from talbot.models.digital.exposure import integration_cycles, slot_cycles
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    AmpTiming,
    ArrayParameters,
    ChipParameters,
    FrameParameters,
    ParameterError,
    RoomParameters,
    SensorParameters,
)
from talbot.models.plan.exposure import exposed_for, fitting


def lit(lux):
    """The default sensor in the light of a room."""
    return RoomParameters(illuminance=lux).lit(SensorParameters())


def test_lux_to_electrons_by_hand():
    """500 lux through f/1.2: a quarter of the aperture's square, as sin(22.6 degrees) = 0.3846."""
    light = RoomParameters().white(10e-6, 1 / 2.4)
    assert light.sensor_lux == pytest.approx(500 * 0.9 * 0.3846**2, rel=1e-3)
    assert light.irradiance == pytest.approx(light.sensor_lux / 243)
    photons = light.irradiance * 1e-10 * 0.4 / 3.6117e-19  # J of a photon of 550 nm
    assert light.electrons == pytest.approx(photons * 0.25, rel=1e-3)
    assert light.current == pytest.approx(light.electrons * ELEMENTARY_CHARGE)


@pytest.mark.parametrize("mode", ["edge", "image", "raw"])
def test_a_room_gives_the_signal(mode):
    sensor = lit(500)
    frame = FrameParameters(sensor.full_window, mode)
    timing = exposed_for(0.8, frame, sensor)
    assert 0 < timing.exposure < sensor.array.rows
    seconds = sum(integration_cycles(timing)) / sensor.chip.f_clk
    electrons = sensor.electrical.white_current * seconds / ELEMENTARY_CHARGE
    step = slot_cycles(timing) / sensor.chip.f_clk * sensor.electrical.white_current / ELEMENTARY_CHARGE
    assert electrons == pytest.approx(0.8 * sensor.electrical.full_well, abs=0.51 * step)


def test_much_and_little_light():
    frame = FrameParameters(SensorParameters().full_window)
    bright, dark = exposed_for(0.8, frame, lit(1e6)), exposed_for(0.8, frame, lit(1))
    assert (bright.exposure, dark.exposure) == (0, 1023)
    assert bright.t_int == round(0.8e5 / (lit(1e6).electrical.white_current / ELEMENTARY_CHARGE) * 10e6) < 512


def test_fitting_lengthens_only_where_rows_would_wait():
    sensor = SensorParameters()
    assert fitting(FrameParameters(sensor.full_window), sensor) == AmpTiming()
    assert fitting(FrameParameters(sensor.full_window, "raw"), sensor).t_int > 512
    one = replace(sensor, chip=ChipParameters(lanes=1), array=ArrayParameters(8, 384))
    assert slot_cycles(fitting(FrameParameters(one.full_window), one)) > 384 * 11


@pytest.mark.parametrize("field, value", [("illuminance", 0), ("efficacy", 700), ("quantum_efficiency", 1.1)])
def test_refused(field, value):
    with pytest.raises(ParameterError):
        RoomParameters(**{field: value})
