"""Nets and transistors of a laid-out cell, found by KLayout."""

from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from talbot.base.gds import db
from talbot.models.parameters import ParameterError
from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.layers import DIFFUSION, GdsLayer

MARKS = ("hvtp", "lvtn", "library")
REACH = 1000  # dbu around a cell in which there is substrate


@dataclass(frozen=True)
class Device:
    """A transistor.

    kind: 'n' or 'p'.
    width, length: um.
    ad, as_: um2, of drain and source; gates divide a shared diffusion.
    pd, ps: um, perimeters of drain and source.
    sa, sb: um from the gate to the ends of its diffusion.
    marks: threshold and library markers over the gate.
    at: centre of the gate, dbu.
    """

    kind: str
    drain: str
    gate: str
    source: str
    bulk: str
    width: float
    length: float
    ad: float
    as_: float
    pd: float
    ps: float
    sa: float
    sb: float
    marks: frozenset[str]
    at: "db.Point"


@dataclass
class CellLayout:
    """Nets and transistors of a cell; regions in dbu.

    dbu: um.
    active: all diffusion, gates included.
    ports: names of labels.
    shapes: conductor (LEF name or DIFFUSION) -> net -> region.
    wells: net -> region.
    islands: 'n' or 'p' -> net -> sources and drains.
    vias: region of each of ExtractionPlatform.vias.
    labels: net -> (conductor, point), the highest conductor first.
    """

    dbu: float
    active: "db.Region"
    ports: set[str] = field(default_factory=set)
    devices: list[Device] = field(default_factory=list)
    shapes: "dict[str, dict[str, db.Region]]" = field(default_factory=dict)
    wells: "dict[str, db.Region]" = field(default_factory=dict)
    islands: "dict[str, dict[str, db.Region]]" = field(default_factory=dict)
    vias: "list[db.Region]" = field(default_factory=list)
    labels: "dict[str, list[tuple[str, db.Point]]]" = field(default_factory=dict)


def read_cell(gds: str | Path, name: str) -> "tuple[db.Layout, db.Cell]":
    """The layout in the file ``gds`` and its cell ``name``, flat. Raises ParameterError where there is none."""
    layout = db.Layout()
    try:
        layout.read(str(gds))
    except RuntimeError as error:
        raise ParameterError(f"gds = {gds}: must be a GDS file ({error})") from None
    cell = layout.cell(name)
    if cell is None:
        raise ParameterError(f"cell = {name!r}: must be in {gds}")
    cell.flatten(True)
    return layout, cell


def find(gds: str | Path, name: str, tech: ExtractionPlatform) -> CellLayout:
    """Nets and transistors of cell ``name`` in the file ``gds``. Raises ParameterError."""
    layout, cell = read_cell(gds, name)
    l2n = db.LayoutToNetlist(db.RecursiveShapeIterator(layout, cell, []))
    layers, texts = _layers(l2n, layout, tech, cell.bbox())
    for kind in "np":
        sides: dict[str, db.ShapeCollection] = {"P": layers["poly"], "W": layers[f"{kind}bulk"]}
        sides |= {"SD": layers[f"{kind}sd"], "G": layers[f"{kind}gate"]}
        l2n.extract_devices(db.DeviceExtractorMOS4Transistor(kind), sides)
    _connect(l2n, layers, texts, tech)
    l2n.extract_netlist()
    circuit = l2n.netlist().top_circuit()
    layout_of_cell = _collect(l2n, circuit, layers, tech, layout.dbu)
    named = {mark: layout.layer(*tech.devices[mark]) for mark in MARKS if mark in tech.devices}
    marks = {mark: db.Region(cell.begin_shapes_rec(layer)) for mark, layer in named.items()}
    layout_of_cell.devices = [_device(device, layout_of_cell, marks) for device in circuit.each_device()]
    layout_of_cell.vias = [_merged(layers[via.lef]) for via in tech.vias]
    layout_of_cell.labels = _labels(layout, cell, tech)
    return layout_of_cell


def _merged(region: "db.Region") -> "db.Region":
    """The region merged, and of no layout any more."""
    merged = db.Region()
    for polygon in region.each_merged():
        merged.insert(polygon)
    return merged


def _labels(layout: "db.Layout", cell: "db.Cell", tech: ExtractionPlatform) -> "dict[str, list[tuple[str, db.Point]]]":
    labels = {}
    for conductor in reversed(tech.conductors):
        for layer in (conductor.pin, conductor.label):
            for shape in cell.shapes(layout.layer(*layer)).each(db.Shapes.STexts):
                point = db.Point() + shape.text_trans.disp
                labels.setdefault(shape.text_string, []).append((conductor.lef, point))
    return labels


def _layers(
    l2n: "db.LayoutToNetlist", layout: "db.Layout", tech: ExtractionPlatform, box: "db.Box"
) -> "tuple[dict[str, db.Region], dict[str, db.Texts]]":
    """Every region and every layer of labels by name, registered, so that ``l2n`` knows the nets of their shapes."""

    def drawn(name: str, layer: GdsLayer) -> "db.Region":
        return l2n.make_layer(layout.layer(*layer), name)

    raw = {name: drawn(name, layer) for name, layer in tech.devices.items() if name not in MARKS}
    conductors = {conductor.lef: drawn(conductor.lef, conductor.gds) for conductor in tech.conductors}
    labels = {f"{conductor.lef}.label": conductor.label for conductor in tech.conductors}
    labels |= {f"{conductor.lef}.pinlabel": conductor.pin for conductor in tech.conductors}
    labels |= {f"well.label{i}": layer for i, layer in enumerate(tech.well_labels)}
    texts = {name: l2n.make_text_layer(layout.layer(*layer), name) for name, layer in labels.items()}
    vias = {via.lef: drawn(via.lef, via.gds) for via in tech.vias}
    active = raw["diff"] + raw.get("tap", db.Region())
    nwell, poly = raw["nwell"], conductors["poly"]
    pwell = db.Region(box.enlarged(REACH)) - nwell
    pactive = active & raw["psdm"]
    nactive = active & raw["nsdm"] if "nsdm" in raw else active - pactive
    n, p = nactive - nwell, pactive & nwell
    derived = {"nbulk": pwell, "pbulk": nwell, "ngate": n & poly, "pgate": p & poly, "nsd": n - poly, "psd": p - poly}
    derived |= {"ntap": nactive & nwell, "ptap": pactive - nwell, "active": active}
    for name, region in derived.items():
        if name != "pbulk":
            l2n.register(region, name)
    return conductors | vias | derived, texts


def _connect(
    l2n: "db.LayoutToNetlist", layers: "dict[str, db.Region]", texts: "dict[str, db.Texts]", tech: ExtractionPlatform
) -> None:
    diffusions = [layers[name] for name in ("nsd", "psd", "ntap", "ptap")]
    conductors = [layers[conductor.lef] for conductor in tech.conductors]
    for region in [*conductors, *diffusions, layers["nbulk"], layers["pbulk"]]:
        l2n.connect(region)
    for conductor in tech.conductors:
        l2n.connect(layers[conductor.lef], texts[f"{conductor.lef}.label"])
        l2n.connect(layers[conductor.lef], texts[f"{conductor.lef}.pinlabel"])
    l2n.connect(layers["pbulk"], layers["ntap"])
    l2n.connect(layers["nbulk"], layers["ptap"])
    for i, bulk in enumerate(("pbulk", "nbulk")[: len(tech.well_labels)]):
        l2n.connect(layers[bulk], texts[f"well.label{i}"])
    for via in tech.vias:
        l2n.connect(layers[via.lef])
        l2n.connect(layers[via.lef], layers[via.above])
        for below in via.below:
            for region in diffusions if below == DIFFUSION else [layers[below]]:
                l2n.connect(layers[via.lef], region)


def _collect(
    l2n: "db.LayoutToNetlist",
    circuit: "db.Circuit",
    layers: "dict[str, db.Region]",
    tech: ExtractionPlatform,
    dbu: float,
) -> CellLayout:
    layout = CellLayout(dbu, _merged(layers["active"]))
    groups = {DIFFUSION: ("nsd", "psd", "ntap", "ptap")} | {layer.lef: (layer.lef,) for layer in tech.conductors}
    layout.shapes = {conductor: {} for conductor in groups}
    layout.islands = {"n": {}, "p": {}}

    def add(regions: "dict[str, db.Region]", net: "db.Net", *names: str) -> None:
        region = db.Region()
        for name in names:
            region += l2n.shapes_of_net(net, layers[name], True)
        if not region.is_empty():
            regions[node(net)] = regions.get(node(net), db.Region()) + region.merged()

    for net in circuit.each_net():
        if net.name:
            layout.ports.add(node(net))
        for conductor, names in groups.items():
            add(layout.shapes[conductor], net, *names)
        for kind, islands in layout.islands.items():
            add(islands, net, f"{kind}sd")
        for bulk in ("nbulk", "pbulk"):
            add(layout.wells, net, bulk)
    return layout


def node(net: "db.Net") -> str:
    """A net's name as SPICE can hold it: its label (the first of several), or n<number>."""
    return net.name.split(",")[0] if net.name else f"n{net.cluster_id}"


def _device(device: "db.Device", layout: CellLayout, marks: "dict[str, db.Region]") -> Device:
    net = {t.name: node(device.net_for_terminal(t.id())) for t in device.device_class().terminal_definitions()}
    value, at = device.parameter, device.trans.disp
    point = db.Point(round(at.x / layout.dbu), round(at.y / layout.dbu))
    spot = db.Region(db.Box(point.x - 5, point.y - 5, point.x + 5, point.y + 5))
    drain, gate, source, bulk = (net[terminal] for terminal in "DGSB")
    width, length, *sides = (value(name) for name in ("W", "L", "AD", "AS", "PD", "PS"))
    sa, sb = _stress(layout, point, width, length)
    over = frozenset(mark for mark, region in marks.items() if not region.interacting(spot).is_empty())
    kind = device.device_class().name
    return Device(kind, drain, gate, source, bulk, width, length, *sides, sa=sa, sb=sb, marks=over, at=point)


def _stress(layout: CellLayout, point: "db.Point", width: float, length: float) -> tuple[float, float]:
    """SA and SB (um) of a gate with its middle at ``point``: where the diffusion's end has steps, BSIM4's equivalent.

    1 / (SA + L / 2) is the mean over the gate's width of that of each strip (BSIM4.5 manual, 13.4, SA and SB for
    irregular shapes): most of the stress comes from the nearest edge.
    """
    box, half = layout.active.bbox(), round(width / layout.dbu / 2)
    gate = db.Box(point.x - 1, point.y - half, point.x + 1, point.y + half)
    band = db.Region(db.Box(box.left, gate.bottom, box.right, gate.top)) & layout.active
    corners = {corner.y for part in band.each_merged() for corner in part.each_point_hull()}
    levels = sorted(y for y in corners | {gate.bottom, gate.top} if gate.bottom <= y <= gate.top)
    inverse, covered = [0.0, 0.0], 0
    for low, high in pairwise(levels):
        strip = db.Region(db.Box(box.left, low, box.right, high)) & band
        runs = (part.bbox() for part in strip.each_merged())
        run = next((run for run in runs if run.contains(db.Point(point.x, low))), None)
        if run is None:  # half a database unit off, for a gate of an odd width
            continue
        covered += high - low
        for side, dbu in enumerate((point.x - run.left, run.right - point.x)):
            inverse[side] += (high - low) / (dbu * layout.dbu)
    sa, sb = (covered / value - length / 2 for value in inverse)
    return sa, sb
