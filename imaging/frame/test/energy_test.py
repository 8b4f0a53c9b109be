"""Energy: both readings of the table, events, light; and that every default says where it comes from."""

import numpy as np
import pytest

from talbot.imaging.frame.figures import edge_pays_below, image_mode, light_line, summarize
from talbot.imaging.frame.job import simulate_frame
from talbot.imaging.frame.outputs import assumptions, energy_parts
from talbot.imaging.frame.request import request
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.digital.scan import Scan
from talbot.models.parameters import (
    CameraParameters,
    CircuitEnergy,
    ConverterParameters,
    ElectricalParameters,
    EnergyParameters,
    FrameParameters,
    LightParameters,
    RoomParameters,
    Window,
    sources,
)
from talbot.models.parameters.energy import DigitalEvents, Events
from talbot.models.pixel.response import vignetting

FULL = Events(147456, 147456, 1 / 30, 8 * 147456, 0)


def test_a_frame_that_converts_everything_takes_the_table_s_power():
    parts = EnergyParameters().frame(FULL)
    assert sum(low for name, (low, _) in parts.items() if name != "digital") * 30 == pytest.approx(1.8e-3)
    # If the table's converters were gated, a full conversion takes 8 / 2.8 of that.
    assert parts["adcs"][1] / parts["adcs"][0] == pytest.approx(8 / 2.8)


def test_a_gated_frame_takes_the_table_s_power_in_the_other_reading():
    events = FULL._replace(decisions=round((2 + 0.1 * 8) * 147456))
    assert EnergyParameters().frame(events)["adcs"][1] * 30 == pytest.approx(100e-6, rel=1e-5)


DIGITAL = DigitalEvents(300_000, 384, 147456, 300_000, 20_000, 36_864)
GATES = {"cycle": 20e-12, "row": 1e-10, "sample": 3e-12, "decision": 2e-12, "byte": 5e-12, "division": 7e-12}


def test_a_total_takes_the_digital_part_from_one_source():
    energy = EnergyParameters(**GATES, glitches=1.5, leakage=2e-6)
    events = FULL._replace(digital=DIGITAL)
    parts = energy.frame(events)
    by_hand = 1.5 * sum(e * n for e, n in zip(GATES.values(), DIGITAL, strict=True)) + 2e-6 / 30
    assert parts["digital"] == pytest.approx((by_hand, by_hand)) and by_hand < parts["timing"][0]
    rest = [sum(value[i] for name, value in parts.items() if name not in ("timing", "digital")) for i in (0, 1)]
    assert energy.total(events) == pytest.approx((rest[0] + by_hand, rest[1] + 500e-6 / 30))
    swapped = EnergyParameters(**GATES | {"cycle": 200e-12}, glitches=1.5, leakage=2e-6).total(events)
    assert swapped[0] == pytest.approx(rest[0] + 500e-6 / 30) and swapped[1] > swapped[0]


@pytest.mark.parametrize("made", [1, 9000, 147456])
def test_at_the_share_where_edges_pay_both_modes_take_the_same(made):
    """A frame in which that share is converted, with as many bytes and changes of pins for each."""
    samples, sent, toggles = 147456, 2.2, 7
    events = FULL._replace(toggles=toggles * made, digital=DIGITAL._replace(bytes=round(sent * made)))
    share = edge_pays_below(events, made)
    at = share * samples
    decisions = 2 * samples + 8 * at
    edge = events._replace(decisions=decisions, toggles=events.toggles / made * at)
    edge = edge._replace(digital=DIGITAL._replace(decisions=decisions, bytes=events.digital.bytes / made * at))
    plain = image_mode(events, samples)
    first, second = (EnergyParameters().frame(one) for one in (edge, plain))
    names = "adcs", "digital", "pads"
    assert sum(first[n][0] for n in names) == pytest.approx(sum(second[n][0] for n in names)) and 0.5 < share < 1


def test_the_circuits_energy_is_that_of_their_events():
    """Every lane is strobed from the sample until the last decision of its step, whatever it has to decide."""
    events = FULL._replace(decisions=1000, digital=DIGITAL, pulses=384 * 4, strobes=3000)
    parts = CircuitEnergy().frame(events)
    assert parts["amplifiers"] == pytest.approx(147456 * 150e-12)  # 22 uJ; never off they would take 292
    assert parts["columns"] == pytest.approx(147456 * 56.1e-12) and parts["rows"] == pytest.approx(1536 * 63.6e-12)
    assert parts["converters"] == pytest.approx(1000 * 2.02e-12 + 3000 * 0.555e-12 + 2000 * 1e-12)


@pytest.mark.parametrize("mode", ["edge", "raw"])
def test_strobes_are_those_of_the_steps(mode):
    sensor = request(9, 50, lanes=4).sensor
    frame = FrameParameters(Window(0, 1, 1, 6), mode=mode, mask=0x5A5A5A, threshold=12 if mode == "edge" else 0)
    samples = np.random.default_rng(3).uniform(0, 127, (1, 9, 50, 2))
    golden = golden_frame(samples, sensor, frame, front_end_of(sensor, (0,) * 24))
    decisions = front_end_of(sensor, (0,) * 24).convert(samples, mode, frame.threshold).decisions
    scan, strobes = Scan(9, 50, 4, frame, sensor.tile), 0
    for row in scan.row_list:
        for step in scan.steps(int(row)):
            columns = [6 * (4 * step.group + lane) + step.k for lane in range(4) if step.enable >> lane & 1]
            strobes += 4 * (1 + max(int(decisions[step.sub, row, column]) for column in columns)) if columns else 0
    assert golden.strobes == strobes > golden.decisions


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
    "kind", [CameraParameters, CircuitEnergy, ElectricalParameters, EnergyParameters, LightParameters, RoomParameters]
)
def test_every_default_names_its_source(kind):
    rows = sources(kind())
    assert len(rows) > 3 and all(row.source and row.source != "set" for row in rows)
    name, value = rows[0].name, rows[0].value
    changed = {row.name: row.source for row in sources(kind(**{name: value / 2}))}
    assert changed[name] == "set" and list(changed.values()).count("set") == 1


def test_an_ideal_converter_is_all_zero():
    ideal = vars(ConverterParameters())
    assert not np.any([value for name, value in ideal.items() if name != "seed"])


@pytest.fixture(scope="module")
def echo():
    """A small frame in time of flight."""
    return simulate_frame(request(13, 50, lanes=4, mode="tof"))


def test_the_chart_of_energy_has_every_part_of_the_total_once(echo):
    s = summarize(echo)
    energy, parts = s["energy_uj"], energy_parts(s)
    assert sum(parts.values()) == pytest.approx(energy["total"])
    assert min(energy["timing"], energy["digital"]) in parts.values()
    swapped = s | {"energy_uj": energy | {"timing": 0.0}}
    assert "digital part (Table 6.1)" in energy_parts(swapped)


def test_every_assumption_has_one_name_and_a_unit(echo):
    rows = {row.name: row for row in assumptions(echo)}
    assert len(rows) == len(assumptions(echo))
    assert (rows["room wavelength"].value, rows["light source wavelength"].value) == (550e-9, 850e-9)
    assert rows["room wavelength"].unit == rows["array pitch"].unit == "m"
    assert rows["room quantum_efficiency"].value != rows["light source quantum_efficiency"].value


def test_light_of_time_of_flight_stands_beside_the_limit_for_an_eye(echo):
    s = summarize(echo)
    source, lens = s["light_source"], echo.request.sensor.optics.camera
    field = (10e-6 / lens.magnification) ** 2 * 13 * 50  # m^2
    assert source["power_w"] * 0.3 / field == pytest.approx(source["irradiance"])
    assert s["energy_uj"]["light"] == pytest.approx(1e6 * source["power_w"] * source["lit_s"])
    assert source["mean_irradiance"] <= source["irradiance"]
    assert f"{source['mean_irradiance'] / 100:.2g} times the limit of 100 W/m2" in light_line(s)
    dim = s | {"light_source": source | {"mean_irradiance": 30.0}}
    assert "within the limit of 100 W/m2" in light_line(dim)
