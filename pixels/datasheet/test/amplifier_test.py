"""The amplifier in ngspice against (Ca a - Cb b) / Cf, and with planted faults."""

from dataclasses import replace

import pytest

from talbot.cells.corner import Corner
from talbot.pixels.circuits.amplifier import UNITS, amplifier
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet import amplifier as measurements
from talbot.pixels.datasheet import job

SETUP, LANE = job.setup_of("sky130")
CORNER = Corner.parse(job.TYPICAL)
SPEC, SIZES = job.amplifier_of(SETUP, LANE)
ngspice = pytest.mark.needs("ngspice")


def output(a: float, b: float, code: int = UNITS, circuit: Circuit | None = None) -> float:
    """V above vref that the lane samples, a and b V below the reset level; the sample before was 0.4 V lower."""
    load = measurements.load_of(SETUP, LANE, CORNER)
    with measurements.opened(SETUP, SPEC, circuit or amplifier(SIZES), CORNER) as spice:
        wave = measurements.sample(spice, SPEC, CORNER, load, a, b, code, SPEC.vref - 0.4)
    return wave.at("lane", measurements.END * SPEC.hold) - SPEC.vref


def faults(circuit: Circuit) -> list[str]:
    return measurements.faults(SETUP, SPEC, SIZES, LANE, CORNER, circuit)


def swapped(circuit: Circuit) -> Circuit:
    """An amplifier with its columns exchanged inside."""
    other = {"column_a": "column_b", "column_b": "column_a"}
    return replace(
        circuit,
        capacitors=tuple(c._replace(b=other.get(c.b, c.b)) for c in circuit.capacitors),
        instances=tuple(i._replace(nodes=tuple(other.get(n, n) for n in i.nodes)) for i in circuit.instances),
    )


@ngspice
@pytest.mark.parametrize("a, b, code", [(0.2, 0.1, UNITS), (0.1, 0.2, UNITS), (0.3, 0.3, 384)])
def test_the_output_is_that_of_the_capacitors(a, b, code):
    closed = SIZES.gain * (a - code / UNITS * b)
    assert output(a, b, code) == pytest.approx(closed, rel=0.03, abs=0.5 * SETUP.spec.lsb)


@ngspice
def test_less_current_does_not_settle_in_a_cycle():
    """A fifth of the transconductance: five times the time constant."""
    ota = SIZES.ota
    slow = replace(ota, tails=round(ota.tails / 5), pair=ota.pair / 5, sink=ota.sink / 5)
    assert abs(output(0.2, 0.0, circuit=amplifier(replace(SIZES, ota=slow))) - output(0.2, 0.0)) > 2 * SETUP.spec.lsb


@ngspice
@pytest.mark.slow
def test_the_specification_is_met_at_the_typical_corner():
    found = measurements.measure(SETUP, SPEC, SIZES, LANE, CORNER)
    assert abs(found.gain - 1) < SPEC.gain and found.inl < SPEC.inl and found.trim < SPEC.trim
    assert found.left < SPEC.settling and found.settling < SPEC.hold
    # Off between two samples it takes a tenth of what it takes on, and nothing that counts while it is off
    assert found.energy < 0.15 * found.always and found.off < 1e-6
    assert found.ambient < SPEC.ambient and 0.2 * SPEC.energy < found.energy < SPEC.energy


@ngspice
@pytest.mark.slow
def test_faults_are_named():
    whole = amplifier(SIZES)
    assert faults(swapped(whole)) == ["amplifier: column_a and column_b: must not be swapped"]
    (gain,) = faults(whole.with_capacitors({"f": 2 * SIZES.feedback * SIZES.unit}))
    assert gain.startswith("amplifier: gain of column_a = 0.")
    (weight,) = faults(whole.with_capacitors({"b7": 64 * SIZES.unit}))
    assert weight.startswith("amplifier: capacitor b7 = 0.5")


def test_sampled_noise_is_that_of_both_inputs():
    """kT/C of each, over Cf: four times the capacitors have half of it, three times the temperature its root."""
    typical = measurements.ktc(SETUP, SIZES, CORNER)
    assert measurements.ktc(SETUP, replace(SIZES, unit=4 * SIZES.unit), CORNER) == pytest.approx(typical / 2)
    # 2 k T C / Cf2, C = 1237 units of 2.35 fF, Cf = 213 of them, LSB 4.69 mV
    by_hand = (2 * 1.380649e-23 * 300.15 * 1237.33 * 2.3499e-15) ** 0.5 / (213.33 * 2.3499e-15) / 4.6875e-3
    assert typical == pytest.approx(by_hand, rel=1e-3)
