"""PDKMaster's description of a process and its cells, exported for KLayout and simulators."""

import re
from collections.abc import Sequence
from typing import Any

from talbot.platforms.layers import Layer
from talbot.platforms.layout import LayoutPlatform


def routing_rules(tech: LayoutPlatform, primitives: Any) -> dict[str, Any]:
    """Rules of the metal layers and vias in PDKMaster's ``primitives``, in um: for JSON."""

    def enclosure(layers: Sequence[Any], enclosures: Sequence[Any], metal: Layer) -> list[float]:
        """By ``metal``, one of ``layers``."""
        found = next(made for layer, made in zip(layers, enclosures, strict=True) if layer.name == metal.name)
        return [float(found.first), float(found.second)]

    metals = {metal.name: primitives[metal.name] for metal in tech.metals}
    vias = {}
    for via, low, high in zip(tech.vias, tech.metals, tech.metals[1:]):
        own = primitives[via.name]
        below = enclosure(own.bottom, own.min_bottom_enclosure, low)
        vias[via.name] = {"below": below, "above": enclosure(own.top, own.min_top_enclosure, high)}
    return {
        "space_um": {name: float(metal.min_space) for name, metal in metals.items()},
        "metals": {
            name: {
                "width": float(own.min_width),
                "space": float(own.min_space),
                "wide_space": float(own.space_table[-1][-1]) if own.space_table else 0.0,
                "area": float(own.min_area or 0),
            }
            for name, own in metals.items()
        },
        "vias": vias,
    }


def cell_area(cell: Any) -> float:
    """Area of a cell, um2."""
    box = cell.layout.boundary
    return round((box.right - box.left) * (box.top - box.bottom), 4)


def export_spice(cells: Sequence[Any], devices: Any) -> str:
    """Subcircuits of the cells. devices: the package's prims_spiceparams."""
    from pdkmaster.io.spice import SpiceNetlistFactory

    netlists = SpiceNetlistFactory(params=devices)
    return with_transistors("".join(netlists.export_circuit(cell.circuit) for cell in cells))


def with_transistors(spice: str) -> str:
    """SPICE with every transistor as a device: KLayout does not know those that a process has as subcircuits."""
    cells = set(re.findall(r"(?im)^\.subckt (\S+)", spice))

    def device(match: re.Match[str]) -> str:
        """The line as a transistor, unless it is a cell."""
        return match[0] if match[2] in cells else f"M{match[1]}{match[2]}{match[3]}"

    return re.sub(r"(?m)^X(\S+ (?:\S+ ){4})(\w+)((?: \w+=\S+)+)$", device, spice)
