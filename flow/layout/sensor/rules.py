"""Rules of the metal layers and vias, in nm."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from talbot.platforms.layers import Via as PlatformVia
from talbot.platforms.layout import LayoutPlatform


@dataclass(frozen=True)
class Layer:
    """A metal layer: its GDS layer and datatype, least width and space (nm), least area (nm2), preferred direction."""

    name: str
    layer: int
    datatype: int
    width: int
    space: int
    area: int
    horizontal: bool

    @property
    def half(self) -> tuple[int, int]:
        """Half of the (width, height) of a pad of the least width."""
        return self.width // 2, self.width // 2


@dataclass(frozen=True)
class Via:
    """Between RoutingRules.layers[k] and [k + 1], k its place.

    size, space (nm); below, above: half of the (width, height) of both pads.
    """

    name: str
    layer: int
    datatype: int
    size: int
    space: int
    below: tuple[int, int]
    above: tuple[int, int]


@dataclass(frozen=True)
class RoutingRules:
    """Layers from that of the cells' pins up, and the vias between them."""

    layers: tuple[Layer, ...]
    vias: tuple[Via, ...]

    @classmethod
    def of(cls, tech: LayoutPlatform, rules: Mapping[str, Any]) -> "RoutingRules":
        """From the platform and the library step's rules, "metals" and "vias" in um."""
        layers = []
        for level, metal in enumerate(tech.metals):
            own = rules["metals"][metal.name]
            width, space, area = round(own["width"] * 1e3), round(own["space"] * 1e3), round(own["area"] * 1e6)
            layers.append(Layer(metal.name, metal.layer, metal.datatype, width, space, area, horizontal=level % 2 == 1))
        vias = []
        for level, via in enumerate(tech.vias):
            own = rules["vias"][via.name]
            pads = _pad(layers[level], via, own["below"]), _pad(layers[level + 1], via, own["above"])
            size, space = round(via.size_um * 1000), round(via.space_um * 1000)
            vias.append(Via(via.name, via.layer, via.datatype, size, space, *pads))
        return cls(tuple(layers), tuple(vias))


def _pad(layer: Layer, via: PlatformVia, enclosure: Sequence[float]) -> tuple[int, int]:
    """Half of the (width, height) of ``via`` and its enclosure by ``layer``, larger along the layer's direction."""
    less, more = (max(layer.width, round(1000 * (via.size_um + 2 * e))) // 2 for e in sorted(enclosure))
    return (more, less) if layer.horizontal else (less, more)
