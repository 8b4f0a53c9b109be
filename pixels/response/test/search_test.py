"""The search, and the tile's types on its gratings."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.base.gds import read_gds
from talbot.models.parameters import OpticsParameters, PixelType, TileParameters
from talbot.pixels.designs import DESIGNS
from talbot.pixels.optics.design import REACHED, WAVELENGTHS_UM, measure
from talbot.pixels.response.drawn import write_tile
from talbot.pixels.response.errors import errors
from talbot.pixels.response.page import pareto
from talbot.pixels.response.pictures import around
from talbot.pixels.response.search import Plan, bandwidth, search
from talbot.pixels.response.types import (
    AZIMUTHS,
    DEGREES,
    RAY_DEGREES,
    measured,
    name_of,
    solve_around,
    solve_one,
    stacked,
)
from talbot.pixels.tabled import rows
from talbot.platforms.optics import optical_stack


def test_a_search_finds_what_reaches_a_beta(tmp_path, monkeypatch):
    """Of two metals of SKY130 and few wavelengths, with coarse solutions kept: the second search solves nothing."""
    monkeypatch.setattr("talbot.pixels.response.search.WAVELENGTHS_UM", WAVELENGTHS_UM[::2])
    stack = optical_stack("sky130")
    two = replace(stack, metals=tuple(m for m in stack.metals if m.name in ("met2", "met3")))
    said = []
    found = search(two, (10.0,), ("interleaved",), tmp_path, said.append)
    (plan,) = found.plans
    assert said == ["candidates", "refine"] and plan.reached(10.0) and plan.score[1] > 0.1
    assert plan.designs[10.0].off(10.0) <= REACHED
    front = found.front
    assert front and all(wide == found.bandwidth_um(design) for design, wide in front)
    assert max(wide for _, wide in front) > 0 and found.bandwidth_um(plan.designs[10.0]) >= 0
    chart = pareto(found)
    *series, staircase = chart.axes[0].lines
    assert all(line.get_linestyle() == "None" for line in series) and staircase.get_linestyle() == "-"
    assert np.all(np.diff(staircase.get_xdata()) >= 0) and np.all(np.diff(staircase.get_ydata()) <= 0)
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


def test_every_type_of_the_tile_is_drawn_at_its_angle():
    chosen, tile = DESIGNS["sky130"], TileParameters()
    designs = {beta: measure(geometry, chosen.wavelength_um) for beta, geometry in chosen.geometries.items()}
    plan = Plan("amplitude", chosen.wavelength_um, designs)
    one = {
        beta: measured(design, [chosen.wavelength_um], [solve_one(design.geometry, chosen.wavelength_um)])
        for beta, design in designs.items()
    }
    rays = {beta: np.array(solve_around(design.geometry, chosen.wavelength_um)) for beta, design in designs.items()}
    panels = around(tile, plan, one, rays).axes
    assert [axes.get_title() for axes in panels] == [name_of(tile.types[number]) for number in tile.order]
    for axes, number in zip(panels, tile.order, strict=True):
        kind = tile.types[number]
        first, _, second, _ = axes.get_lines()
        azimuths, shares = (np.asarray(line, float) for line in first.get_data())
        # What a ray along the gratings' normal has is a point of the curves over the angle
        along = one[kind.beta].response.unpolarized[0][rows(kind.alpha, one[kind.beta].fit)[0]]
        at = int(np.argmin(np.abs(azimuths - kind.gamma)))
        assert shares[at] == pytest.approx(100 * np.interp(RAY_DEGREES, DEGREES, along), abs=1e-6)
        if kind.alpha:  # in quadrature a ray from the other side is the other diode's
            assert np.asarray(second.get_ydata(), float)[at] == pytest.approx(shares[at + AZIMUTHS.size // 2], abs=1e-6)


@pytest.mark.needs("layout")
def test_a_tile_is_drawn_of_a_plan_or_refused(tmp_path):
    chosen, tile = DESIGNS["sky130"], TileParameters()
    designs = {beta: measure(geometry, chosen.wavelength_um) for beta, geometry in chosen.geometries.items()}
    plan = Plan("amplitude", chosen.wavelength_um, designs)
    assert write_tile(plan, tile, tmp_path / "tile.gds") == ""
    layout = read_gds(tmp_path / "tile.gds")
    assert sum(1 for _ in layout.top_cell().each_inst()) == tile.n_types
    wrong = replace(plan.designs[18.0], geometry=replace(plan.designs[18.0].geometry, diffraction="met3"))
    said = write_tile(replace(plan, designs={**plan.designs, 18.0: wrong}), tile, tmp_path / "none.gds")
    assert said.startswith("diffraction, analyzer = met3, met1: must be met4 over met1 or met2")
    assert not (tmp_path / "none.gds").exists()


@pytest.mark.slow
def test_errors_fall_with_what_is_kept():
    """Of a grating with a coarse, smooth response; what is held for the truth has no error."""
    found = errors(replace(DESIGNS["sky130"].geometries[12.0], period_um=2.4), 0.575, OpticsParameters())
    names = "orders", "wavelengths", "degrees", "angles in a view", "samples"
    assert tuple(dict.fromkeys(row.what for row in found)) == names
    for name in names:
        rows = [row for row in found if row.what == name]
        assert 0 < rows[-1].error < rows[0].error / 2 and all(row.seconds > 0 for row in rows)


def test_bandwidth_ends_where_m_is_below_its_half():
    wavelengths = [0.5, 0.525, 0.55, 0.575, 0.6]
    assert bandwidth(wavelengths, [0.5, 0.1, 0.3, 0.4, 0.15], 3) == pytest.approx(0.025)
    assert bandwidth(wavelengths, [0.5, 0.3, 0.3, 0.4, 0.2], 2) == pytest.approx(0.1)
