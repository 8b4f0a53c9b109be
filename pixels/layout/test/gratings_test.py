"""Lines on the grid: period, fill and direction as wanted, rules kept, shifts where they should be."""

import numpy as np
import pytest

from talbot.base.gds import db
from talbot.models.parameters import ParameterError, TileParameters
from talbot.pixels.layout.gratings import Lines, lines, octilinear, polygons

WINDOW = 100, 600, 850, 1980
GAMMAS = sorted({kind.gamma_deg for kind in TileParameters().types})


def across(made: Lines, corners: list[tuple[int, int]]) -> np.ndarray:
    """Positions of corners along the exact normal of the drawn lines, within a quarter degree of the wanted one."""
    p, q = made.direction
    normal = np.array([-q, p]) / np.hypot(p, q)
    if normal @ [np.cos(made.normal), np.sin(made.normal)] < 0:
        normal = -normal
    return np.array(corners) @ normal


@pytest.mark.parametrize("gamma", [*GAMMAS, 10.0, -80.0])
@pytest.mark.parametrize(("period", "fill", "width"), [(160, 0.5, 60), (140, 0.43, 60), (140, 0.535, 28)])
def test_lines_have_the_period_and_the_widths(gamma, period, fill, width):
    made = lines(np.deg2rad(gamma), period, fill, width, width)
    found = [across(made, corners) for corners in polygons(made, WINDOW, 0.0)]
    widths, middles = [np.ptp(a) for a in found], np.sort([a.mean() for a in found])
    assert abs(made.off) < np.pi / 720
    assert np.allclose(widths, made.line)
    assert min(widths) > width - 1e-9
    assert np.allclose(np.diff(middles), made.period)  # none is left out between two others
    assert made.period == pytest.approx(period, rel=0.02)
    assert made.period - made.line > width - 1e-9


@pytest.mark.parametrize("gamma", GAMMAS)
def test_a_shift_moves_lines_along_the_normal(gamma):
    made = lines(np.deg2rad(gamma), 140, 0.45, 60, 60)

    def phase(shift: float) -> float:
        turns = [across(made, corners).mean() / made.period for corners in polygons(made, WINDOW, shift)]
        return float(np.angle(np.mean(np.exp(2j * np.pi * np.array(turns)))) / (2 * np.pi))

    for shift in (0.25, 0.5, 0.75):
        moved = (phase(shift) - phase(0.0)) % 1.0
        assert moved == pytest.approx(shift, abs=0.01)


@pytest.mark.parametrize("gamma", [*GAMMAS, 10.0])
def test_corners_are_right_inside_the_window_and_on_the_grid(gamma):
    made = lines(np.deg2rad(gamma), 140, 0.5, 60, 60)
    left, bottom, right, top = WINDOW
    count = 0
    for corners in polygons(made, WINDOW, 0.3):
        count += 1
        points = np.array(corners)
        assert points.dtype.kind == "i"
        assert (points >= [left, bottom]).all()
        assert (points <= [right, top]).all()
        sides = np.roll(points, -1, 0) - points
        turns = np.einsum("ij,ij->i", sides, np.roll(sides, -1, 0))
        assert (turns == 0).all()  # right angles
    assert count > 4


def test_a_period_without_room_is_refused():
    with pytest.raises(ParameterError, match="must have room for a line of 60"):
        lines(0.3, 100, 0.5, 60, 60)


@pytest.mark.needs("layout")
@pytest.mark.parametrize("gamma", [-67.5, -22.5, 22.5, 67.5])
@pytest.mark.parametrize("shift", [0.0, 0.5])
def test_octilinear_lines_keep_rules_and_place(gamma, shift):
    made, window = lines(np.deg2rad(gamma), 140, 0.43, 60, 60), (0, 0, 1700, 1700)
    straight, steps = db.Region(), db.Region()
    for corners in polygons(made, window, shift):
        straight.insert(db.Polygon([db.Point(*point) for point in corners]))
        if drawn := octilinear(corners, made):
            steps.insert(db.Polygon([db.Point(*point) for point in drawn]))
    assert all(0 in (edge.dx(), edge.dy()) or abs(edge.dx()) == abs(edge.dy()) for edge in steps.edges().each())
    assert steps.width_check(60).count() == 0
    assert steps.space_check(50).count() == 0  # ends may be nearer than lines: the deck checks the drawn pixels
    assert steps.bbox().inside(db.Box(*window))
    assert (steps - straight).area() < 0.06 * straight.area()  # between the straight line's sides but for the steps
    assert 0.9 < steps.area() / straight.area() < 1.0


def test_octilinear_leaves_other_lines_and_refuses_other_directions():
    for gamma in (0.0, 45.0, 90.0):
        made = lines(np.deg2rad(gamma), 140, 0.5, 60, 60)
        assert all(octilinear(corners, made) == corners for corners in polygons(made, WINDOW, 0.0))
    made = lines(np.deg2rad(10.0), 140, 0.5, 60, 60)
    with pytest.raises(ParameterError, match="direction = .*: must be a multiple of 45 degrees"):
        octilinear(next(polygons(made, WINDOW, 0.0)), made)
