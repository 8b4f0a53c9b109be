"""Optical stacks: figures against one another and against published tables."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError
from talbot.platforms.materials import MATERIALS, RANGE_UM, refractive_index
from talbot.platforms.optics import optical_stack
from talbot.platforms.processes import PROCESSES


@pytest.mark.parametrize(
    "material, wavelength_um, expected, within",
    [
        # refractiveindex.info's tables of the same papers, which were computed or typed by others
        ("aluminium", 0.54127, 0.92804 + 6.3634j, 1e-3),
        ("aluminium", 0.81300, 2.7157 + 8.2271j, 1e-3),
        ("copper", 0.53241, 0.63358 + 2.6025j, 1e-3),
        ("copper", 0.80344, 0.24149 + 4.9706j, 1e-3),
        # and of others: Malitson at the sodium line, Palik's nitride, Aspnes's silicon
        ("silica", 0.5893, 1.4584, 1e-4),
        ("nitride", 0.6328, 2.02, 0.02),
        ("silicon", 0.6199, 3.906 + 0.022j, 0.02),
    ],
)
def test_indices_are_the_published_ones(material, wavelength_um, expected, within):
    assert abs(refractive_index(material, wavelength_um) - expected) < within


@pytest.mark.parametrize("material", MATERIALS)
def test_indices_are_passive_over_the_range(material):
    index = refractive_index(material, np.linspace(*RANGE_UM, 131))
    assert (index.real > 0).all() and (index.imag >= 0).all()


@pytest.mark.parametrize("wavelength", [0.2, 1.2, np.nan, -1.0, [0.5, 1e9]])
def test_a_wavelength_without_an_index(wavelength):
    with pytest.raises(ParameterError, match=r"wavelength_um = .*: must be in \[0.35, 1\]"):
        refractive_index("silica", wavelength)
    with pytest.raises(ParameterError, match="material = 'gold': must be one of"):
        refractive_index("gold", 0.5)


@pytest.mark.parametrize("pdk", PROCESSES)
def test_metals_lie_inside_the_films_in_order(pdk):
    stack = optical_stack(pdk)
    assert all(low.top_um < high.bottom_um for low, high in zip(stack.metals, stack.metals[1:], strict=False))
    tops = [film.top_um for film in stack.films]
    assert tops == sorted(tops) and tops[0] > 0
    assert {m.material for m in (*stack.metals, *stack.films)} <= set(MATERIALS)
    assert all(round(x / stack.grid_um, 6) % 1 == 0 for m in stack.metals for x in (m.width_um, m.space_um))


def test_the_second_table_of_heights():
    first, second = optical_stack("sky130"), optical_stack("sky130", "met2-2.301")
    assert second.metal("metal", "met1") == first.metal("metal", "met1")
    assert second.metal("metal", "met4").bottom_um == pytest.approx(first.metal("metal", "met4").bottom_um + 0.295)
    with pytest.raises(ParameterError, match="heights = 'high': must be one of met2-2.006, met2-2.301"):
        optical_stack("sky130", "high")
    with pytest.raises(ParameterError, match="analyzer = 'met9': must be one of met1, met2, .* metals of sky130"):
        first.metal("analyzer", "met9")
