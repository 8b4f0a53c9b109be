"""The lane in ngspice against closed forms, against itself with other capacitors, and with planted faults."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.cells.corner import Corner
from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.comparator import comparator
from talbot.pixels.circuits.dac import dac
from talbot.pixels.circuits.lane import sar_lane
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet import comparator as comparators
from talbot.pixels.datasheet import job, lane, linearity
from talbot.pixels.datasheet.datasheet import Row, over_corners

SETUP, SIZES = job.setup_of("sky130")
CORNER = Corner.parse(job.TYPICAL)
ngspice = pytest.mark.needs("ngspice")


def swapped(circuit: Circuit) -> Circuit:
    """A comparator whose strong-arm latch has its inputs exchanged."""
    first, *rest = circuit.instances
    nodes = ("inn", "inp", *first.nodes[2:])
    return replace(circuit, instances=(first._replace(nodes=nodes), *rest))


@ngspice
def test_half_an_lsb_is_decided_and_swapped_inputs_are_found():
    found = comparators.decisions(SETUP, SIZES, CORNER)
    assert found.right and 0.1e-9 < found.delay < SETUP.spec.half_cycle
    # CV2 of the pair's and the latch's drains, about: 0.1 to 1 pF at 1.8 V
    assert 0.3e-12 < found.energy < 3e-12
    wrong = comparators.decisions(SETUP, SIZES, CORNER, swapped(comparator(SIZES.comparator)))
    assert not wrong.right


@ngspice
@pytest.mark.slow
def test_faults_are_named():
    """Swapped inputs of the comparator, and a bit's capacitor of half its value, in a whole lane."""
    whole = sar_lane(SIZES)
    other = whole.replaced(swapped(comparator(SIZES.comparator)))
    assert lane.faults(SETUP, SIZES, CORNER, other) == ["comparator: inp and inn: must not be swapped"]
    array = dac(SIZES.dac)
    half = array.with_capacitors({"bit5": 16 * SIZES.dac.unit})
    named = lane.faults(SETUP, SIZES, CORNER, whole.replaced(half))
    assert len(named) == 1 and named[0].startswith(("DAC: capacitor bit5 = 0.4", "DAC: capacitor bit5 = 0.5"))


@ngspice
@pytest.mark.slow
def test_levels_of_a_drawn_array_are_those_of_charge_conservation():
    """ngspice against the closed form, for one array with four times the mismatch."""
    drawn = linearity.drawn(4 * SIZES.dac.unit_mismatch, np.random.default_rng(5))
    names = [*(f"bit{k}" for k in range(8)), "terminator", "half"]
    values = dict(zip(names, drawn * SIZES.dac.unit, strict=True))
    circuit = sar_lane(SIZES).replaced(dac(SIZES.dac).with_capacitors(values))
    closed = linearity.levels(drawn) - (np.arange(256) - 0.5)
    with lane.open_lane(SETUP, SIZES, CORNER, circuit) as spice:
        _, errors, gain = lane._levels(spice, SETUP, (1, 255, 64, 128, 127))
    assert np.ptp(closed) > 0.5  # the array is off by more than what is compared
    for code, error in errors:
        assert error == pytest.approx(closed[code], abs=0.03)
    assert gain == pytest.approx(SIZES.attenuation, rel=0.08)  # the oxide is more than the gate's capacitance


@ngspice
@pytest.mark.slow
def test_a_decision_is_made_at_the_level_that_the_plates_have():
    """The comparator's kick does not depend on the code: with unlike switches it was off by -0.69 LSB at 250."""
    with lane.open_lane(SETUP, SIZES, CORNER) as spice:
        found = dict(lane._decided(spice, SETUP, (8, 250, 128)))
    assert max(abs(off) for off in found.values()) < 0.2


@ngspice
@pytest.mark.slow
def test_offsets_have_the_spread_of_pelgroms_law_and_the_seed_decides():
    """Two batches: the rms of 20 is within a factor of 1.6 of the limit that the pair was sized for."""
    first = comparators.offsets(SETUP, SIZES, CORNER, 1)
    assert first == comparators.offsets(SETUP, SIZES, CORNER, 1)
    rms, low, high = comparators.interval([*first, *comparators.offsets(SETUP, SIZES, CORNER, 2)])
    assert SETUP.spec.offset / 1.6 < rms < 1.6 * SETUP.spec.offset and low < rms < high


def test_a_missing_capacitor_is_named_before_anything_runs():
    broken = sar_lane(SIZES).replaced(dac(SIZES.dac).without("bit5"))
    with pytest.raises(ParameterError, match="circuit dac: net b5 at device switch5"):
        lane.faults(SETUP, SIZES, CORNER, broken)
    with pytest.raises(ParameterError, match="circuit comparator: ports"):
        lane.open_lane(SETUP, SIZES, CORNER, comparator(SIZES.comparator))


def test_linearity_of_an_ideal_array_is_ideal():
    units = linearity.drawn(0.0, np.random.default_rng(1))
    level = linearity.levels(units)
    assert np.allclose(level, np.arange(256) - 0.5)
    found = linearity.tested(level, 0.0, 0.0, 1)
    # Quantization alone, of a sine over 251 of 256 codes
    assert found.enob == pytest.approx(8 + np.log2(250 / 256), abs=0.03)
    assert found.inl < 0.02 and found.dnl < 0.04


def test_a_ramp_finds_the_levels_of_a_drawn_array():
    level = linearity.levels(linearity.drawn(0.01, np.random.default_rng(3)))
    inl, dnl = linearity.inl_dnl(level)
    found = linearity.tested(level, 0.0, 0.0, 1)
    assert found.inl == pytest.approx(inl, abs=0.04) and found.dnl == pytest.approx(dnl, abs=0.06)


def test_the_step_at_mid_scale_has_the_spread_of_its_units():
    """Rms of level(128) - level(127) over 4000 arrays: sqrt(255) units."""
    steps = []
    for seed in range(4000):
        level = linearity.levels(linearity.drawn(0.002, np.random.default_rng(seed)))
        steps.append(level[128] - level[127])
    assert np.std(steps) == pytest.approx(0.002 * 255**0.5, rel=0.04)


def test_a_row_passes_only_inside_its_limits():
    row = over_corners("dac", "settling", "ns", [("tt", 4.0), ("ss", 9.0)], "tt", most=8.0)
    assert (row.low, row.typical, row.high, row.worst, row.passes) == (4.0, 4.0, 9.0, "ss", False)
    assert Row("lane", "ENOB", "bit", 7.6, 7.4, 7.8, least=7.3).passes
    assert not Row("lane", "ENOB", "bit", 7.6, 7.2, 7.8, least=7.3).passes
    assert not Row("lane", "noise", "LSB", float("nan"), None, None, most=1.0).passes


def test_a_statistic_that_its_draws_do_not_bound_is_open():
    def row(low, typical, high):
        return Row("comparator", "offset, rms", "LSB", typical, low, high, most=0.5, draws=20)

    assert row(0.3, 0.4, 0.49).verdict == "pass" and row(0.3, 0.4, 0.49).passes
    assert row(0.3, 0.45, 0.6).verdict == row(0.4, 0.52, 0.64).verdict == "open"
    assert row(0.51, 0.6, 0.7).verdict == "FAIL" and Row("lane", "gain", "LSB", 1.0, None, 2.0).verdict == ""
    assert Row("lane", "INL", "LSB", 0.4, 0.3, 0.6, most=0.5).verdict == "FAIL"  # corners, no statistic
    assert row(0.4, 0.52, 0.64).draws_needed is None
    needed = row(0.3, 0.4, 0.5).draws_needed
    scale = np.array(comparators.interval(np.random.default_rng(1).standard_normal(needed)))
    assert scale[2] / scale[0] == pytest.approx(0.5 / 0.4, rel=0.01)


def test_a_trimmed_level_is_shown_within_a_quarter_of_an_lsb():
    """0.5 mV of 1.95 mV: to three digits of a volt it would be up to 2.6 LSB of every dark sample."""
    row = over_corners("column", "level", "mV", [("tt", 1133.392), ("ff", 1126.7)], "tt")
    assert [float(row.texts[k]) for k in (2, 3)] == pytest.approx([1126.7, 1133.392], abs=0.51)


@pytest.mark.parametrize("text", ["tt", "", "tt_027C_2v50", "xx_027C_1v80", "ss_150C_1v80"])
def test_corners_are_refused_by_name(text):
    with pytest.raises(ParameterError, match="corner"):
        job.corners_of(text)


def test_corners_have_the_typical_one_first():
    assert job.corners_of("ff_125C_1v98") == (job.TYPICAL, "ff_125C_1v98")
    assert len(job.corners_of("all")) == 21
