"""A row's driver in ngspice: against the line's closed form, and with planted faults."""

from dataclasses import replace
from math import log, pi

import pytest

from talbot.cells.corner import Corner
from talbot.pixels.circuits.row_driver import RowDriverSpec, bank, row, row_line
from talbot.pixels.datasheet import job, row_driver
from talbot.pixels.datasheet.deck import EDGE, deck, simulator

pytestmark = pytest.mark.needs("ngspice", "layout")
SETUP, _ = job.setup_of("sky130")
CORNER = Corner.parse(job.TYPICAL)
SPEC = RowDriverSpec.of()


def measured(spec=SPEC, driver=None):
    return row_driver.measure(SETUP, spec, CORNER, driver, (1.0,))


@pytest.fixture(scope="module")
def sound():
    return measured()


def test_the_far_end_follows_the_diffusion_equation(sound):
    """A line that is driven at one end: 4 / pi exp(-pi2 t / 4 RC) is left at the other; the driver adds its own."""
    line = 384 * SPEC.ohm * 384 * SPEC.farad * 4 / pi**2 * log(4 / pi / row_driver.FAR)
    assert sound.right and line < sound.settling < line + 10e-9
    # A pulse takes C V2 from the lines' supply, and the driver's own
    closed = 384 * SPEC.farad * SPEC.high**2
    assert closed < sound.energy < 1.1 * closed


def test_a_row_line_that_is_cut_is_found(monkeypatch):
    """One resistor of 1e12 ohm, as a break is: the far ends stay where they were."""

    def cut(spec):
        line = row_line(spec)
        return replace(line, resistors=tuple(r._replace(value=1e12) if r.name == "b7" else r for r in line.resistors))

    monkeypatch.setattr(row_driver, "row_line", cut)
    found = measured()
    assert not found.right and found.settling > 0.9 * SPEC.settle


def test_a_shifter_whose_holding_transistors_are_too_strong_is_found():
    """It does not move where what must win is the weaker one."""
    (shifter,) = (one.circuit for one in row().instances if one.name == "read_l")
    strong = tuple(t._replace(w=10.0, l=0.5) if t.name in ("pa", "pb") else t for t in shifter.transistors)
    assert not measured(driver=row().replaced(replace(shifter, transistors=strong))).right


@pytest.mark.parametrize("corner", [job.TYPICAL, "ff_n40C_1v98"])
@pytest.mark.parametrize("late, rests", [(1e-9, True), (4e-9, False)])
def test_a_read_that_is_before_its_reset_moves_no_row(corner, late, rests):
    """Both rise with one edge; `ref_ctl` may be 1 ns behind. On the die before this pin it was 0.32 ns ahead"""
    one, whole = Corner.parse(corner), bank()
    own = tuple(part for part in whole.instances if part.name.startswith(("read_", "ref_ctl_")))
    ports = "read", "ref_ctl", "read_line", "vdd", "vss"
    circuit, at, end = replace(whole, ports=ports, instances=own), 5e-9, 25e-9
    edges = {"read": [(at, one.supply)], "ref_ctl": [(at + late, one.supply), (end, 0.0)]}
    driven = {}
    for name, steps in edges.items():
        points, level = [(0.0, 0.0)], 0.0
        for time, to in steps:
            points += [(time, level), (time + EDGE, to)]
            level = to
        driven[name] = points
    with simulator(deck(circuit, SETUP, one), driven, ("read_line",), one) as spice:
        wave = spice.transient(driven, {"read_line": 1.5e-12}, 35e-9, 1e-10)
    peak = wave.voltage["read_line"][wave.time < end].max()
    assert (peak < 0.01 * one.supply) == rests
    assert wave.at("read_line", end + 5e-9) > 0.99 * one.supply
