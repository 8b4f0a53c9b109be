"""Layers and vias of a process: the types of the tables ``talbot/platforms/<pdk>/layers.py``.

Every description of a process (extraction, layout, OpenROAD, die) is built from that one table.
"""

from dataclasses import dataclass

DIFFUSION = "diffusion"  # source, drain and taps, as a conductor below the layers

GdsLayer = tuple[int, int]  # layer, datatype


@dataclass(frozen=True, kw_only=True)
class Layer:
    """A conducting layer above the field; a coefficient of 0 is one that no tool here reads.

    name, lef: in PDKMaster; in LEF and in extracted netlists. layer, datatype, label_datatype,
    pin_datatype: GDS numbers of shapes, net names and pin shapes. area_af_um2, fringe_af_um: aF/um2 and aF/um of edge,
    to the substrate. sidewall_af_um: aF times length / (distance + sidewall_offset_um) between facing edges.
    sheet_ohm: ohm a square. antenna_ratio: limit of side wall (or metal) area by gate area on a net without a
    diffusion; antenna_diffusion: limit at no diffusion, and what every um2 of it adds. width_um, space_um: minimum.
    min_hole_um2: minimum area of a hole, where PDKMaster's rules have none.
    """

    name: str
    lef: str
    layer: int
    datatype: int
    label_datatype: int
    pin_datatype: int
    area_af_um2: float = 0.0
    fringe_af_um: float = 0.0
    sidewall_af_um: float = 0.0
    sidewall_offset_um: float = 0.0
    sheet_ohm: float = 0.0
    thickness_um: float = 0.0
    antenna_ratio: float = 0.0
    antenna_diffusion: tuple[float, float] = (0.0, 0.0)
    width_um: float = 0.0
    space_um: float = 0.0
    min_hole_um2: float = 0.0

    @property
    def gds(self) -> GdsLayer:
        """GDS layer and datatype of its shapes."""
        return self.layer, self.datatype

    @property
    def label(self) -> GdsLayer:
        """GDS layer and datatype of its net names."""
        return self.layer, self.label_datatype

    @property
    def pin(self) -> GdsLayer:
        """GDS layer and datatype of its pin shapes."""
        return self.layer, self.pin_datatype


@dataclass(frozen=True, kw_only=True)
class Via:
    """A via, or a contact to diffusion and poly; a size of 0 is one that no tool here reads.

    name, lef, layer, datatype: see `Layer`. below, above: LEF names of what it connects. size_um, space_um: of one
    via, and between two. enclosure_um: by both layers; enclosure_below_um: by the lower one, where it differs.
    ohm: of one via.
    """

    name: str
    lef: str
    layer: int
    datatype: int
    below: tuple[str, ...]
    above: str
    size_um: float = 0.0
    space_um: float = 0.0
    enclosure_um: float = 0.0
    enclosure_below_um: float = 0.0
    ohm: float = 0.0

    @property
    def gds(self) -> GdsLayer:
        """GDS layer and datatype of its shapes."""
        return self.layer, self.datatype


@dataclass(frozen=True)
class Crossing:
    """Capacitance between two layers, one above the other; their LEF names, or DIFFUSION.

    overlap_af_um2: of the area where they overlap. down_af_um, up_af_um: of an edge of the upper one to the lower one
    next to it, and of an edge of the lower one to the upper.
    """

    upper: str
    lower: str
    overlap_af_um2: float
    down_af_um: float
    up_af_um: float
