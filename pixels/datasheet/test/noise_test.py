"""Noise of decisions: statistics against the normal distribution, the deck's sources, and a comparator's memory."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from talbot.cells.corner import Corner
from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.comparator import comparator
from talbot.pixels.circuits.gates import nand
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.datasheet import job, noise
from talbot.pixels.datasheet.deck import EDGE, clock, deck, simulator

SETUP, SIZES = job.setup_of("sky130")
CORNER = Corner.parse(job.TYPICAL)
ngspice = pytest.mark.needs("ngspice")
SIGNS = (1, 1, -1, -1, 1, -1)


def follows(circuit: Circuit, lsb: float) -> bool:
    """Whether decisions of +-``lsb``, in the order of SIGNS, are right."""
    spec, period = SETUP.spec, noise.PERIOD
    step = lsb * spec.lsb * SIZES.attenuation / 2
    up = [(0.0, spec.vcm + SIGNS[0] * step)]
    for k in range(1, len(SIGNS)):
        up += [(k * period, spec.vcm + SIGNS[k - 1] * step), (k * period + EDGE, spec.vcm + SIGNS[k] * step)]
    down = [(t, 2 * spec.vcm - v) for t, v in up]
    with simulator(deck(circuit, SETUP, CORNER), ("inp", "inn", "strobe"), ("q",), CORNER) as spice:
        stimulus = {"inp": up, "inn": down, "strobe": clock(len(SIGNS), period, CORNER.supply)}
        wave = spice.transient(stimulus, {"q": noise.LOAD}, len(SIGNS) * period, period / 100)
    ends = [wave.at("q", (k + 1) * period) > CORNER.supply / 2 for k in range(len(SIGNS))]
    return ends == [sign > 0 for sign in SIGNS]


@ngspice
def test_a_decision_does_not_depend_on_the_one_before():
    """A comparator whose holding latch is right at the strong-arm's outputs does: it is loaded by what it holds."""
    whole = comparator(SIZES.comparator)
    assert follows(whole, 0.02)
    gate = nand()
    held = (
        Instance("set", gate, ("outn", "qn", "q", "vdd", "vss")),
        Instance("clear", gate, ("outp", "q", "qn", "vdd", "vss")),
    )
    loaded = replace(whole, instances=(whole.instances[0], *held))
    assert not follows(loaded, 0.1) and follows(loaded, 0.5)


@pytest.mark.parametrize("rms", [0.5, 1.0, 2.0])
def test_decisions_of_a_normal_noise_give_its_rms(rms, monkeypatch):
    monkeypatch.setattr(noise, "NOISY", 100_000)
    ones = [int(1e5 * norm.cdf(step / rms)) for step in (-1.0, 1.0)]
    found, low, high = noise._probit(ones, 1.0)
    assert found == pytest.approx(rms, rel=0.01) and low < rms < high < 1.1 * low


def test_the_interval_holds_the_rms_in_19_of_20_cases():
    rng = np.random.default_rng(1)
    inside = 0
    for _ in range(400):
        ones = [int((rng.standard_normal(noise.NOISY) < step).sum()) for step in (-1.0, 1.0)]
        _, low, high = noise._probit(ones, 1.0)
        inside += low <= 1.0 <= high
    assert 0.9 < inside / 400 < 0.99


def test_a_comparator_that_keeps_its_decision_is_refused():
    with pytest.raises(ParameterError, match=r"decisions = \[48, 48\]"):
        noise._probit([48, 48], 1.0)


def test_the_deck_has_a_source_at_every_gate_of_pair_and_latch():
    lines = deck(comparator(SIZES.comparator), SETUP, CORNER)
    noisy = noise._noisy(lines, 1e-4, 7)
    sources = [line for line in noisy if "trnoise(0.0001" in line]
    assert {line.split()[0] for line in sources} == {"Vninp", "Vninn", "Vnlatch_np", "Vnlatch_nn"}
    assert noisy[0] == ".option seed=7" and len(noisy) == len(lines) + 1 + len(sources)


@ngspice
@pytest.mark.slow
def test_noise_of_few_decisions_is_that_of_the_closed_form(monkeypatch):
    """Within a factor of three, which is what twelve decisions at each input tell."""
    monkeypatch.setattr(noise, "NOISY", 12)
    found = noise.noise(SETUP, SIZES, CORNER)
    assert found.ones[0] < found.ones[1] and found.closed / 3 < found.rms < 3 * found.closed
