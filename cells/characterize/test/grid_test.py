"""Axes and searches on functions whose answer is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from talbot.cells.characterize.cell import _without_pin
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.constraint import RESOLUTION, bisect, margin
from talbot.cells.characterize.delay import chosen
from talbot.cells.characterize.grid import _refine
from talbot.cells.characterize.table import bilinear
from talbot.cells.corner import Corner
from talbot.cells.spice.engine import SimulationError
from talbot.models.parameters import ParameterError


def line(function):
    return lambda x: SimpleNamespace(delay=function(x), slew=1.0)


def test_bilinear_is_exact_for_what_is_bilinear():
    rows, columns = np.array([1.0, 2.0, 5.0]), np.array([0.5, 3.0])
    values = 2 + rows[:, None] * 3 - columns + rows[:, None] * columns
    for row, column in ((1.5, 1.0), (4.0, 2.9), (0.5, 4.0)):
        assert bilinear(rows, columns, values, row, column) == pytest.approx(2 + 3 * row - column + row * column)


def test_a_point_goes_where_the_table_bends():
    """A kink at 8 between straight lines: the first point is added in its interval."""
    axis, _ = _refine((1.0, 2.0, 4.0, 16.0, 32.0), [line(lambda x: max(x, 8.0))], 0.01, 1)
    assert axis == (1.0, 2.0, 4.0, 8.0, 16.0, 32.0)


def test_a_straight_line_needs_no_point():
    axis, error = _refine((1.0, 2.0, 4.0), [line(lambda x: 3 * x + 1)], 0.01, 5)
    assert axis == (1.0, 2.0, 4.0) and error < 1e-12


@pytest.mark.parametrize("guess", [None, 30e-12, 60e-12, -900e-12, 990e-12])
def test_bisection_finds_where_the_delay_has_grown_by_its_share(guess):
    """Delay 100 ps (1 + exp(-(x - 20 ps) / 10 ps)), lost below 20 ps: 10 % more at 20 ps + 10 ps ln 10."""
    runs = []

    def run(x):
        runs.append(x)
        return None if x < 20e-12 else 100e-12 * (1 + np.exp(-(x - 20e-12) / 10e-12))

    found = bisect(run, 1e-9, True, 0.1, guess=guess)
    assert found == pytest.approx(20e-12 + 10e-12 * np.log(10), abs=1.1 * RESOLUTION)
    assert len(runs) < 20


def test_a_constraint_that_is_never_kept_is_an_error():
    with pytest.raises(SimulationError, match="not kept even far"):
        bisect(lambda x: None, 1e-9, True, 0.1)


@pytest.mark.parametrize(
    "field, value", [("slews", (2e-9, 1e-9)), ("loads", 1), ("degrade", 0), ("lower", 0.6), ("extra", -1)]
)
def test_conditions_are_checked(field, value):
    with pytest.raises(ParameterError):
        Conditions(Corner("tt", 25, 1.8), **{field: value})


def at(name, **more):
    return Conditions(Corner.parse(name), **more)


def test_slews_are_skywaters_and_limits_within_them():
    assert at("ss_100C_1v60").slews[-1] == 5e-9 and at("ss_100C_1v60").longest_slew == 1.5e-9
    assert at("ss_n40C_1v76").slews[-1] == at("tt_025C_1v80").slews[-1] == 1.5e-9
    assert at("ss_100C_1v60", slews=(1e-11, 1e-9)).longest_slew == 1e-9


@pytest.mark.parametrize("corner, delay", [("tt_025C_1v80", 9), ("ss_100C_1v60", 9), ("ff_n40C_1v95", 1)])
def test_an_arc_is_its_slowest_state_and_at_ff_its_fastest(corner, delay):
    """As in SkyWater's tables; all of nine states are tried, the extremes in the middle of them."""
    bench = SimpleNamespace(
        conditions=at(corner), edge=lambda change, output, slew, load: SimpleNamespace(delay=change)
    )
    assert chosen(bench, SimpleNamespace(changes=[5, 4, 3, 9, 6, 1, 2, 8, 7], output="Y"), 1e-15) == delay


def test_margins_are_for_what_skywaters_tables_have_longer():
    slews = (1e-11, 1e-9)
    setup, hold = margin("setup_rising", 400e-12, slews), margin("hold_falling", 400e-12, slews)
    assert setup == pytest.approx(np.array([[16.1e-12, 26e-12]] * 2))  # data's slews along a row
    assert hold == pytest.approx(np.array([[4.1e-12] * 2, [14e-12] * 2]))
    assert not margin("recovery_rising", 400e-12, slews).any()


def test_the_energy_of_a_pins_edge_is_not_in_the_edge_that_it_causes():
    arc = {"pin": "A", "pin_edge": "rise", "slews": (1.0, 2.0), "energy": [[5.0, 9.0], [6.0, 10.0]]}
    measured = {"arcs": [arc], "slews": (1.0, 3.0), "quiet_energy": {"A": {"rise": [2.0, 4.0], "fall": [0.0, 0.0]}}}
    _without_pin(measured)
    assert arc["energy"] == [[3.0, 7.0], [3.0, 7.0]]
