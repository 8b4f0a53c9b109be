"""What the rules ask of wires and cuts, in nm."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Layer:
    """layer, datatype: of GDS. width, space: least (nm); area: least (nm2). across: whether wires run west to east."""

    name: str
    layer: int
    datatype: int
    width: int
    space: int
    area: int
    across: bool


@dataclass(frozen=True)
class Cut:
    """Between Wiring.layers[k] and [k + 1], k its place. size: nm. below, above: half of the pad's (width, height)."""

    name: str
    layer: int
    datatype: int
    size: int
    below: tuple
    above: tuple


@dataclass(frozen=True)
class Wiring:
    """layers: from the one of the cells' pins up. step: (x, y) of the search's grid, nm."""

    layers: tuple
    cuts: tuple
    step: tuple

    @classmethod
    def of(cls, known, rules):
        """known: CoriolisPlatform. rules: of the library step, "wires" and "cuts" in um."""
        asked = [rules["wires"][wire.name] for wire in known.metals]
        layers = tuple(
            Layer(
                w.name,
                w.layer,
                w.datatype,
                round(a["width"] * 1e3),
                round(a["space"] * 1e3),
                round(a["area"] * 1e6),
                across=level % 2 == 1,
            )
            for level, (w, a) in enumerate(zip(known.metals, asked, strict=True))
        )
        cuts = tuple(
            Cut(
                c.name,
                c.layer,
                c.datatype,
                round(c.size_um * 1000),
                *(
                    _pad(layers[level + above], c, rules["cuts"][c.name][side])
                    for above, side in enumerate(("below", "above"))
                ),
            )
            for level, c in enumerate(known.vias)
        )
        pitch = known.pin_pitch_um
        return cls(layers, cuts, (round(pitch["vertical"] * 500), round(pitch["horizontal"] * 500)))


def _pad(layer, cut, enclosure):
    """Half of the (width, height) of ``cut`` with what ``layer`` must have around it; more along its wires."""
    less, more = (max(layer.width, round(1000 * (cut.size_um + 2 * e))) // 2 for e in sorted(enclosure))
    return (more, less) if layer.across else (less, more)
