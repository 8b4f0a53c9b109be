"""Mismatch and noise of the amplifier: its seed decides, capacitors alone give the spread of their cells, kT/C."""

from math import sqrt

import numpy as np
import pytest

from talbot.base.jobs import Job, run
from talbot.cells.corner import Corner
from talbot.pixels.circuits.amplifier import UNITS, amplifier
from talbot.pixels.datasheet import amplifier as measurements
from talbot.pixels.datasheet import job, spread, supply
from talbot.pixels.datasheet.converter import polynomial
from talbot.pixels.datasheet.tables import _table, text
from talbot.platforms.sky130 import analog as process

SETUP, LANE = job.setup_of("sky130")
CORNER = Corner.parse(job.TYPICAL)
SPEC, SIZES = job.amplifier_of(SETUP, LANE)
ngspice = pytest.mark.needs("ngspice")


@ngspice
def test_the_seed_decides_so_that_a_run_that_went_on_gives_the_same():
    one, again, other = (spread.drawn(SETUP, SPEC, SIZES, LANE, CORNER, seed) for seed in (1, 1, 2))
    assert one == again and one.offset != other.offset
    assert abs(one.offset) < 3 and abs(one.gain - 1) < SPEC.gain


def test_capacitors_spread_by_the_root_of_their_cells():
    whole = amplifier(SIZES)
    ratio = []
    for seed in range(300):
        values = {c.name: c.value for c in spread.with_mismatch(whole, SIZES, process.CELL_MISMATCH, seed).capacitors}
        ratio.append(values["a"] / values["f"] / SIZES.gain)
    closed = process.CELL_MISMATCH * sqrt(1 / (UNITS * SIZES.cells) + 1 / (SIZES.feedback * SIZES.cells))
    assert np.std(ratio) == pytest.approx(closed, rel=0.15) and np.mean(ratio) == pytest.approx(1, abs=closed / 4)


@ngspice
@pytest.mark.slow
def test_noise_of_the_reset_is_above_that_of_the_capacitors_alone():
    """kT/C of both inputs is what no amplifier is below; its own comes on top, and less with the lane's array."""
    closed = measurements.ktc(SETUP, SIZES, CORNER)
    found = spread.noise(SETUP, SPEC, SIZES, LANE, CORNER, closed)
    assert closed < found.reset < 5 * closed and 0.01 < found.signal < found.reset
    assert found.total == pytest.approx(sqrt(found.reset**2 + found.signal**2))


@ngspice
def test_ripple_of_the_supply_is_least_where_the_loop_has_gain():
    found = supply.ripple(SETUP, SPEC, SIZES, LANE, CORNER)
    slow, fast = found.gain[0], found.gain[found.hertz.index(1e8)]
    assert 1e-4 < slow < 0.3 * fast < 0.03 and (found.hertz[0], found.hertz[-1]) == (1e4, 1e9)


def test_a_cubic_gives_its_own_points_back():
    x = np.linspace(-96, 96, 5) / 128
    bend, rest = polynomial([(128 * v, 128 * v + 0.1 - 0.5 * v + 0.2 * v**2 - 0.3 * v**3) for v in x])
    assert bend == pytest.approx((0.1, -0.5, 0.2, -0.3)) and rest < 1e-9


def test_tables_are_what_the_models_say():
    kept = process.TABLES.read_text()
    assert text(process._tables()) == kept


@ngspice
def test_a_table_is_that_of_the_process():

    assert _table(process, "p_lvt", 0.5) == process._tables()["p_lvt 0.5"]
    one = process.operating("p_lvt", 0.5, 14.0)
    assert one.density > process.operating("p_lvt", 0.5, 16.0).density and 10 < one.gain < 30


@ngspice
@pytest.mark.slow
def test_a_run_that_was_stopped_goes_on_with_the_same_figures(tmp_path):
    jobs = [Job(f"draw-{k}", spread.drawn, (SETUP, SPEC, SIZES, LANE, CORNER, k), (k,)) for k in (1, 2, 3)]
    first = run(jobs[:2], tmp_path, "draws", 1)
    jobs[1].file(tmp_path).unlink()
    assert run(jobs, tmp_path, "draws", 1)[:2] == first
