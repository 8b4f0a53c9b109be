"""Nets and transistors of a laid-out cell, found by KLayout."""

from dataclasses import dataclass, field

import klayout.db as db

from models.parameters import ParameterError
from platforms.layers import DIFFUSION

MARKS = ("hvtp", "lvtn", "library")


@dataclass(frozen=True)
class Device:
    """A transistor. kind: 'n' or 'p'. w, l: um; ad, as_: um2; pd, ps: um, a shared diffusion divided among its gates;

    sa, sb: um from the gate to the ends of its diffusion. marks: the threshold and library marks over the gate.
    at: middle of its gate, dbu.
    """

    kind: str
    drain: str
    gate: str
    source: str
    bulk: str
    w: float
    l: float
    ad: float
    as_: float
    pd: float
    ps: float
    sa: float
    sb: float
    marks: frozenset
    at: db.Point


@dataclass
class Layout:
    """What was found. shapes: conductor (a wire's name or DIFFUSION) -> net -> region (in dbu); wells: net -> region;

    ports: the names that labels give; dbu: um. active: all diffusion, gates included. islands: 'n' or 'p' -> net ->

    sources and drains; vias: region of every one of ExtractionPlatform.vias; labels: net -> [(layer, point)], highest
    first.
    """

    dbu: float
    ports: set
    devices: list
    shapes: dict = field(default_factory=dict)
    wells: dict = field(default_factory=dict)
    active: db.Region = None
    islands: dict = field(default_factory=dict)
    vias: list = field(default_factory=list)
    labels: dict = field(default_factory=dict)


def read_cell(gds, name):
    """(db.Layout, its cell ``name``, flat). Raises ParameterError for a file or cell that is not there."""
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


def find(gds, name, tech):
    """The Layout of cell ``name`` in the file ``gds`` in the process ``tech`` (ExtractionPlatform)."""
    layout, cell = read_cell(gds, name)
    l2n = db.LayoutToNetlist(db.RecursiveShapeIterator(layout, cell, []))
    layers = _layers(l2n, layout, tech, cell.bbox())
    for kind in "np":
        extractor = db.DeviceExtractorMOS4Transistor(kind)
        l2n.extract_devices(
            extractor,
            {"SD": layers[f"{kind}sd"], "G": layers[f"{kind}gate"], "P": layers["poly"], "W": layers[f"{kind}bulk"]},
        )
    _connect(l2n, layers, tech)
    l2n.extract_netlist()
    circuit = l2n.netlist().top_circuit()
    found = _collect(l2n, circuit, layers, tech)
    found.dbu = layout.dbu
    strips = {
        mark: db.Region(cell.begin_shapes_rec(layout.layer(*tech.devices[mark])))
        for mark in MARKS
        if mark in tech.devices
    }
    found.devices = [_device(device, found, strips) for device in circuit.each_device()]
    found.vias = [db.Region(list(layers[via.lef].each_merged())) for via in tech.vias]
    found.labels = _labels(layout, cell, tech)
    return found


def _labels(layout, cell, tech):
    found = {}
    for wire in reversed(tech.conductors):
        for layer in (wire.pin, wire.label):
            for shape in cell.shapes(layout.layer(*layer)).each(db.Shapes.STexts):
                found.setdefault(shape.text_string, []).append((wire.lef, db.Point() + shape.text_trans.disp))
    return found


def _layers(l2n, layout, tech, box):
    """Every region by name; all registered, so that their nets can be asked for."""

    def drawn(name, spec):
        return l2n.make_layer(layout.layer(*spec), name)

    raw = {name: drawn(name, spec) for name, spec in tech.devices.items() if name not in MARKS}
    layers = {wire.lef: drawn(wire.lef, wire.gds) for wire in tech.conductors}
    layers |= {
        f"{wire.lef}.label": l2n.make_text_layer(layout.layer(*wire.label), f"{wire.lef}.label")
        for wire in tech.conductors
    }
    layers |= {
        f"{wire.lef}.pinlabel": l2n.make_text_layer(layout.layer(*wire.pin), f"{wire.lef}.pinlabel")
        for wire in tech.conductors
    }
    for i, spec in enumerate(tech.well_labels):
        layers[f"well.label{i}"] = l2n.make_text_layer(layout.layer(*spec), f"well.label{i}")
    for via in tech.vias:
        layers[via.lef] = drawn(via.lef, via.gds)
    active = raw["diff"] + raw.get("tap", db.Region())
    nwell, poly = raw["nwell"], layers["poly"]
    pwell = db.Region(box.enlarged(1000)) - nwell
    pactive = active & raw["psdm"]
    nactive = active & raw["nsdm"] if "nsdm" in raw else active - pactive
    made = {
        "nbulk": pwell,
        "pbulk": nwell,
        "ngate": (nactive - nwell) & poly,
        "pgate": (pactive & nwell) & poly,
        "nsd": nactive - nwell - poly,
        "psd": (pactive & nwell) - poly,
        "ntap": nactive & nwell,
        "ptap": pactive - nwell,
        "active": active,
    }
    for name, region in made.items():
        if name != "pbulk":
            l2n.register(region, name)
    return layers | made


def _connect(l2n, layers, tech):
    diffusions = [layers[name] for name in ("nsd", "psd", "ntap", "ptap")]
    own = [layers[wire.lef] for wire in tech.conductors] + diffusions + [layers["nbulk"], layers["pbulk"]]
    for region in own:
        l2n.connect(region)
    for wire in tech.conductors:
        l2n.connect(layers[wire.lef], layers[f"{wire.lef}.label"])
        l2n.connect(layers[wire.lef], layers[f"{wire.lef}.pinlabel"])
    l2n.connect(layers["pbulk"], layers["ntap"])
    l2n.connect(layers["nbulk"], layers["ptap"])
    for i, bulk in enumerate(("pbulk", "nbulk")[: len(tech.well_labels)]):
        l2n.connect(layers[bulk], layers[f"well.label{i}"])
    for via in tech.vias:
        cut = layers[via.lef]
        l2n.connect(cut)
        l2n.connect(cut, layers[via.above])
        for lower in via.below:
            for region in diffusions if lower == DIFFUSION else [layers[lower]]:
                l2n.connect(cut, region)


def _collect(l2n, circuit, layers, tech):
    found = Layout(dbu=0, ports=set(), devices=[], active=db.Region(list(layers["active"].each_merged())))
    groups = {DIFFUSION: ("nsd", "psd", "ntap", "ptap")} | {wire.lef: (wire.lef,) for wire in tech.conductors}
    found.shapes = {conductor: {} for conductor in groups}
    found.islands = {"n": {}, "p": {}}
    for net in circuit.each_net():
        name = node(net)
        if net.name:
            found.ports.add(name)
        for conductor, names in groups.items():
            region = db.Region()
            for layer in names:
                region += l2n.shapes_of_net(net, layers[layer], True)
            if not region.is_empty():
                found.shapes[conductor][name] = found.shapes[conductor].get(name, db.Region()) + region.merged()
        for kind, islands in found.islands.items():
            region = l2n.shapes_of_net(net, layers[f"{kind}sd"], True)
            if not region.is_empty():
                islands[name] = islands.get(name, db.Region()) + region.merged()
        for bulk in ("nbulk", "pbulk"):
            region = l2n.shapes_of_net(net, layers[bulk], True)
            if not region.is_empty():
                found.wells[name] = found.wells.get(name, db.Region()) + region.merged()
    return found


def node(net):
    """A net's name as SPICE can hold it: its label (the first of several), or n<number>."""
    return net.name.split(",")[0] if net.name else f"n{net.cluster_id}"


def _device(device, found, strips):
    net = {t.name: node(device.net_for_terminal(t.id())) for t in device.device_class().terminal_definitions()}
    value = device.parameter
    at = device.trans.disp
    point = db.Point(round(at.x / found.dbu), round(at.y / found.dbu))
    w, length = value("W"), value("L")
    spot = db.Region(db.Box(point.x - 5, point.y - 5, point.x + 5, point.y + 5))
    marks = frozenset(mark for mark, strip in strips.items() if not strip.interacting(spot).is_empty())
    box = found.active.bbox()
    line = db.Region(db.Box(box.left, point.y - 1, box.right, point.y + 1)) & found.active
    run = next(part.bbox() for part in line.each_merged() if part.inside(point))
    sa, sb = ((point.x - run.left) * found.dbu - length / 2, (run.right - point.x) * found.dbu - length / 2)
    return Device(
        device.device_class().name,
        net["D"],
        net["G"],
        net["S"],
        net["B"],
        w,
        length,
        value("AD"),
        value("AS"),
        value("PD"),
        value("PS"),
        sa,
        sb,
        marks,
        point,
    )
