"""Parasitics estimated from a net's segments alone.

Each segment counts with its area and its two long edges to the substrate, each via with its
resistance; there is no coupling. `signoff.parasitics` extracts a finished layout.
"""

from collections.abc import Iterable
from typing import NamedTuple

from talbot.platforms.layout import LayoutPlatform


class Parasitics(NamedTuple):
    """Capacitance to the substrate and resistance of a net."""

    femtofarad: float
    ohm: float


def parasitics(segments: Iterable[tuple[str, float, float]], tech: LayoutPlatform) -> Parasitics:
    """Parasitics of a net's ``segments``: (layer, length_um, width_um), a via with length 0."""
    metals = {metal.name: metal for metal in tech.metals}
    names = [metal.name for metal in tech.metals]
    vias = {f"{low}_{via.name}_{high}": via for low, via, high in zip(names, tech.vias, names[1:])}
    attofarad = ohm = 0.0
    for layer, length, width in segments:
        if layer in vias:
            ohm += vias[layer].ohm
        elif layer in metals and length:
            metal = metals[layer]
            attofarad += length * (width * metal.area_af_um2 + 2 * metal.fringe_af_um)
            ohm += length / width * metal.sheet_ohm
    return Parasitics(attofarad / 1000, ohm)
