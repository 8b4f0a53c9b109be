"""What an extraction or an abstract asks of a process: layers by name and the coefficients of its wires."""

from dataclasses import dataclass

DIFFUSION = "diffusion"  # source, drain and taps, as a conductor beside the wires


@dataclass(frozen=True)
class Wire:
    """A conducting layer over the field and what stray capacitance it has.

    layer, label, pin: GDS (layer, datatype) of its shapes, its net names and its pin shapes. area: aF/um2 to the
    substrate. fringe: aF/um of edge to the substrate. sidewall: aF, times length / (distance + offset in um), between
    two facing edges. sheet: ohm a square.
    """

    name: str
    layer: tuple
    label: tuple
    pin: tuple
    area: float
    fringe: float
    sidewall: float
    offset: float
    sheet: float


@dataclass(frozen=True)
class Crossing:
    """Two layers, one above the other. overlap: aF/um2. down, up: aF/um of an edge of the upper one to the lower

    one beside it, and of an edge of the lower to the upper.
    """

    upper: str
    lower: str
    overlap: float
    down: float
    up: float


@dataclass(frozen=True)
class Process:
    """wires: from the lowest. cuts: (GDS layer, lower conductors, upper wire). halo: um, reach of fringe fields.

    devices: layer name -> GDS layer of what makes transistors (active, taps, wells, implants, threshold marks); a
    process without a layer of its own for taps, n implants or marks leaves these out.
    outlines: GDS layers that may hold a cell's outline. well_labels: GDS layers of the names of n well and p substrate.
    contacts: ohm of one cut to what lies under it: 'n', 'p' (diffusion) or a wire's name.
    """

    wires: tuple
    crossings: tuple
    cuts: tuple
    devices: dict
    outlines: tuple
    well_labels: tuple
    halo: float
    contacts: dict

    def wire(self, name):
        return next(wire for wire in self.wires if wire.name == name)
