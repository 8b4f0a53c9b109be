"""The search, the types on its gratings, and what the commands refuse."""

from dataclasses import replace

import numpy as np
import pytest

import talbot
from talbot.commands import main
from talbot.flow.pixel.search import Plan, search
from talbot.flow.pixel.types import measured, solve_one, stacked
from talbot.models.parameters import ParameterError, PixelType, TileParameters
from talbot.pixels.designs import DESIGNS
from talbot.pixels.optics.design import REACHED, measure
from talbot.pixels.tabled import rows, tabled
from talbot.platforms.optics import optical_stack


@pytest.mark.parametrize("pdk", DESIGNS)
def test_the_gratings_kept_have_the_betas_they_are_for(pdk):
    chosen = DESIGNS[pdk]
    assert set(chosen.geometries) == {kind.beta for kind in TileParameters().types}
    for beta, geometry in chosen.geometries.items():
        found = measure(geometry, chosen.wavelength_um)
        assert found.off(beta) < 0.08 and found.fit.m > 0.4 and abs(found.fit.alpha) < 0.1


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


def test_a_solution_by_the_public_name():
    geometry = talbot.pixel.PixelGeometry(period_um=0.74)
    found = talbot.pixel.solve(geometry, np.deg2rad([0, 7, 14]), 550e-9, orders=15)
    assert found.shares.shape == (1, 2, 4, 3) and 0 < found.shares.min() < found.shares.max() < 0.5
    for wavelength, said in ((550, "must be in m"), (2e-6, r"wavelength_um = 2: must be in \[0.35, 1\]")):
        with pytest.raises(ParameterError, match=said):
            talbot.pixel.solve(geometry, [0.0], wavelength)


@pytest.mark.parametrize(
    "words, said",
    [
        ("pixel --pdk tsmc", "pdk = 'tsmc': must be one of sky130, ihp-sg13g2"),
        ("pixel --kind phase", "kind = 'phase': must be one of amplitude, interleaved, all"),
        ("pixel --heights high", "heights = 'high': must be one of met2-2.006, met2-2.301"),
        ("sim --pixel gf180", "pixel = 'gf180': must be one of ideal, sky130, ihp-sg13g2"),
    ],
)
def test_refused_in_one_line(words, said, capsys):
    assert main(words.split()) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1


def test_a_sensor_of_another_beta_is_refused():
    odd = talbot.Sensor(rows=4, cols=4, tile=[[PixelType(15, 0, 0)]]).parameters
    with pytest.raises(ParameterError, match="beta = 15: must be one of 12, 18, 24, which pixel = 'sky130' has"):
        tabled(odd, "sky130")
    assert tabled(odd, "ideal") is odd


@pytest.mark.slow  # a table takes half a minute
def test_a_chip_with_tables_is_equal_to_its_model(tmp_path):
    sensor = talbot.Sensor.of(tabled(talbot.Sensor(rows=24, cols=36, lanes=4).parameters, "sky130"))
    assert "# its response is that of PIXEL=sky130" in sensor.text
    for mode in ("edge", "image", "raw", "tof"):
        run = sensor.simulate("motorcycle", mode=mode)
        assert run.summary["stream_mismatches"] == run.summary["decoded_mismatches"] == 0
