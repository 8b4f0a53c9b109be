"""Switch drivers and bias in ngspice against closed forms, and with planted faults."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.cells.corner import Corner
from talbot.pixels.circuits.amplifier import BIAS
from talbot.pixels.circuits.gates import inverter
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.circuits.support import BARS, BIAS_OHM, SupportSpec, bias
from talbot.pixels.datasheet import job, support
from talbot.pixels.datasheet.deck import deck
from talbot.platforms.sky130 import analog as process

pytestmark = pytest.mark.needs("ngspice")
SETUP, _ = job.setup_of("sky130")
CORNER = Corner.parse(job.TYPICAL)
SPEC = SupportSpec()


def test_phases_do_not_overlap_and_those_of_two_inverters_do():
    gaps, _ = support.phases(SETUP, SPEC, CORNER)
    assert SPEC.gap < min(gaps) <= max(gaps) < SPEC.lost
    supplies = ("vdd", "vss")
    plain = Circuit(
        "plain",
        ("clk", "phi1", "phi2", *supplies),
        instances=(
            Instance("one", inverter(6), ("clk", "phi1", *supplies)),
            Instance("two", inverter(6), ("phi1", "phi2", *supplies)),
        ),
    )
    gaps, _ = support.phases(SETUP, SPEC, CORNER, plain)
    assert min(gaps) < 0


def test_the_bias_starts_and_its_current_is_that_of_its_resistor():
    wave, _ = support.started(SETUP, CORNER)
    current = -float(wave.current["ibias"][-1])
    assert current == pytest.approx(1.08 * BIAS, rel=0.05)
    # Twice the resistor: half the current in weak inversion, a quarter in strong; each branch has over kT/q ln 16 / R
    whole = bias()
    twice = replace(whole, resistors=tuple(r._replace(value=2 * r.value) for r in whole.resistors))
    half = -float(support.started(SETUP, CORNER, twice)[0].current["ibias"][-1])
    assert 0.25 * current < half < 0.55 * current
    assert half > 2 * 0.0259 * np.log(16) / (2 * BIAS_OHM)


def test_its_resistor_has_the_process_at_the_ends():
    slow, fast = (Corner.parse(f"{name}_027C_1v80") for name in ("ss", "ff"))
    lines = [text for text in deck(bias(), SETUP, slow) if text.startswith("Rr")]
    assert len(lines) == BARS and all(line.endswith(f"{{{BIAS_OHM / BARS:g}*rscale}}") for line in lines)
    assert process.resistance("ss", 27) == pytest.approx(1.1) and process.resistance("ff", 27) == pytest.approx(0.9)
    assert process.resistance("tt", 125) > 1.1 > process.resistance("tt", 27) == 1
    currents = [-float(support.started(SETUP, one)[0].current["ibias"][-1]) for one in (slow, fast)]
    typical = -float(support.started(SETUP, CORNER)[0].current["ibias"][-1])
    assert currents[0] < 0.95 * typical < 1.05 * typical < currents[1]


def test_temperature_hardly_changes_its_current_and_one_threshold_alone_would():
    """The difference of the thresholds falls with temperature as the rest rises; without it a third comes or goes."""

    def change(circuit: Circuit) -> float:
        cold, hot = (Corner.parse(f"tt_{name}_1v80") for name in ("n40C", "125C"))
        ends = [-float(support.started(SETUP, one, circuit)[0].current["ibias"][-1]) for one in (cold, hot)]
        return ends[1] / ends[0] - 1

    plain = replace(
        bias(), transistors=tuple(t._replace(role="n") if t.name[:4] == "four" else t for t in bias().transistors)
    )
    assert abs(change(bias())) < 0.12 < 0.15 < change(plain)


def test_a_cold_bias_without_its_starter_does_not_start():
    """At 27 degrees leakage starts it; at ss, -40 degrees it has no current after 30 us."""
    cold = Corner.parse("ss_n40C_1v62")
    found = [
        -float(support.started(SETUP, cold, one)[0].current["ibias"][-1]) for one in (bias(), bias().without("start"))
    ]
    assert found[0] == pytest.approx(BIAS, rel=SPEC.bias) and abs(found[1]) < 0.01 * BIAS
