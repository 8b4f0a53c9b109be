"""Energy: both readings of the table, events, light; and that every default says where it comes from."""

import numpy as np
import pytest

from talbot.models.parameters import (
    CameraParameters,
    ConverterParameters,
    ElectricalParameters,
    EnergyParameters,
    LightParameters,
    RoomParameters,
    sources,
)
from talbot.models.parameters.energy import Events
from talbot.models.pixel.response import vignetting

FULL = Events(147456, 147456, 1 / 30, 8 * 147456, 0)


def test_a_frame_that_converts_everything_takes_the_table_s_power():
    parts = EnergyParameters().frame(FULL)
    assert sum(low for low, _ in parts.values()) * 30 == pytest.approx(1.8e-3)
    # If the table's converters were gated, a full conversion takes 8 / 2.8 of that.
    assert parts["adcs"][1] / parts["adcs"][0] == pytest.approx(8 / 2.8)


def test_a_gated_frame_takes_the_table_s_power_in_the_other_reading():
    events = FULL._replace(decisions=round((2 + 0.1 * 8) * 147456))
    assert EnergyParameters().frame(events)["adcs"][1] * 30 == pytest.approx(100e-6, rel=1e-5)


def test_pads_pay_for_every_change():
    assert EnergyParameters().frame(FULL._replace(toggles=1000))["pads"][0] == pytest.approx(500 * 10e-12 * 1.8**2)


@pytest.mark.parametrize("f_number", [1.2, 2.4])
def test_light_reaches_the_sensor_through_the_same_pupil(f_number):
    """Of the radiance E / pi of a white field, the integral over the pupil of the capture's own vignetting arrives."""
    nu = np.linspace(0, 1 / (2 * f_number), 20001)
    share = np.trapezoid(vignetting(nu, 0 * nu, 4.0) * 2 * np.pi * nu, nu) / np.pi
    sensor = 0.25e-9 / (0.7 * 0.5 * 850 / 1239.842 * 0.4 * (10e-6) ** 2)  # W/m^2
    by_hand = sensor / 0.9 / share * 147456 * (10e-6 / 0.0385) ** 2 / 0.3
    found = LightParameters().power(0.25e-9, 10e-6, 147456, 1 / (2 * f_number), 0.0385)
    assert found == pytest.approx(by_hand, rel=1e-6)


@pytest.mark.parametrize(
    "kind", [CameraParameters, ElectricalParameters, EnergyParameters, LightParameters, RoomParameters]
)
def test_every_default_names_its_source(kind):
    rows = sources(kind())
    assert len(rows) > 3 and all(source and source != "set" for _, _, source in rows)
    name, value, _ = rows[0]
    changed = {n: s for n, _, s in sources(kind(**{name: value / 2}))}
    assert changed[name] == "set" and list(changed.values()).count("set") == 1


def test_an_ideal_converter_is_all_zero():
    ideal = vars(ConverterParameters())
    assert not np.any([value for name, value in ideal.items() if name != "seed"])
