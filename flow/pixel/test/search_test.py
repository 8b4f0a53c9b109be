"""The search, and the tile's types on its gratings."""

from dataclasses import replace

import numpy as np

from talbot.flow.pixel.page import polar
from talbot.flow.pixel.search import Plan, search
from talbot.flow.pixel.types import measured, solve_one, stacked
from talbot.models.parameters import PixelType
from talbot.pixels.designs import DESIGNS
from talbot.pixels.optics.design import REACHED, measure
from talbot.pixels.tabled import rows
from talbot.platforms.optics import optical_stack


def test_a_search_finds_what_reaches_a_beta(tmp_path):
    """Of two metals of SKY130, with coarse solutions kept: the second search solves nothing."""
    stack = optical_stack("sky130")
    two = replace(stack, metals=tuple(m for m in stack.metals if m.name in ("met2", "met3")))
    said = []
    found = search(two, (10.0,), ("interleaved",), tmp_path, said.append)
    (plan,) = found.plans
    assert said == ["candidates", "refine"] and plan.reached(10.0) and plan.score[1] > 0.1
    assert plan.designs[10.0].off(10.0) <= REACHED
    kept = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    assert search(two, (10.0,), ("interleaved",), tmp_path, said.append) == found
    assert {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()} == kept


def test_types_have_diodes_of_their_phase():
    chosen = DESIGNS["sky130"]
    design = measure(chosen.geometries[18.0], chosen.wavelength_um)
    plan = Plan("amplitude", chosen.wavelength_um, {18.0: design})
    one = measured(design, [chosen.wavelength_um], [solve_one(design.geometry, chosen.wavelength_um)])
    even, odd = (PixelType(18, 0, alpha) for alpha in (0.0, np.pi / 2))
    response = stacked([even, odd], plan, {18.0: one}).mean((-2, -1))  # type, diode, angle
    difference = response[:, 0] - response[:, 1]
    np.testing.assert_allclose(difference[0], difference[0, ::-1], atol=1e-9)
    np.testing.assert_allclose(difference[1], -difference[1, ::-1], atol=1e-9)
    middle = difference.shape[1] // 2
    assert difference[0, middle] > 0  # cos(0)
    assert difference[1, middle + 4] < 0  # cos(beta theta + pi/2) falls where the angle rises
    assert rows(np.pi / 2, one.fit) == rows(-np.pi / 2, one.fit)[::-1]


def test_the_polar_picture_is_of_the_solved_curves():
    chosen = DESIGNS["sky130"]
    design = measure(chosen.geometries[12.0], chosen.wavelength_um)
    one = measured(design, [chosen.wavelength_um], [solve_one(design.geometry, chosen.wavelength_um)])
    (axes,) = polar({12.0: one}).axes
    first, form, second, _ = (np.asarray(line.get_ydata(), float) for line in axes.get_lines())
    np.testing.assert_allclose([first, second], 100 * one.response.unpolarized[0][[0, 2]])
    assert np.corrcoef(first, form)[0, 1] > 0.6 and np.corrcoef(first, second)[0, 1] < 0
