"""Blocks that were laid out before: cells with pins and obstructions, whose instances stay where the floorplan says.

A wire leads from each pin out of the block, to where the router meets it. That to an input goes over a piece of the
highest wire: whatever is joined to it outside is no antenna to the gate inside until that piece is there.
"""

from coriolis import CRL
from coriolis.helpers import u
from coriolis.Hurricane import (
    Box,
    Cell,
    DataBase,
    Horizontal,
    Instance,
    Library,
    Net,
    NetExternalComponents,
    Pad,
    Transformation,
    UpdateSession,
)

GAUGE = "StdCellLib"
HOP_PADS = 2.0, 6.5  # from the edge of the block, in pads: where the wire goes up, where it comes down
PAD_LENGTH = 2.0  # of a pad between two cuts by its width: what the least area of a wire asks
MEET_UM = 0.8, 2.4  # beyond what the block keeps free: the piece that the router meets


def make_macros(request):
    """A cell for each of the request's macros, before the netlist that holds them is read."""
    if not request["macros"]:
        return
    database = DataBase.getDB()
    library = Library.create(database.getRootLibrary(), "Macros")
    UpdateSession.open()
    for macro in request["macros"]:
        _make(Cell.create(library, macro["name"]), macro, request)
    UpdateSession.close()
    CRL.AllianceFramework.get().wrapLibrary(library, 0)


def _make(cell, macro, request):
    """Draw it; its origin is that of its outer box."""
    layer = DataBase.getDB().getTechnology().getLayer
    left, bottom, right, top = macro["outer"]
    x, y, row = macro["x_um"] - left, macro["y_um"] - bottom, request["row_um"]
    edges = x, x + macro["width_um"]
    cell.setAbutmentBox(Box(0, 0, u(right - left), u(top - bottom)))
    obstacles = Net.create(cell, "*")
    low, high = y - request["over_um"], y + macro["height_um"] + request["over_um"]
    for wire in request["wires"]:
        Pad.create(obstacles, layer(f"{wire['name']}.block"), _box(edges[0] - row, low, edges[1] + row, high))
    for name, leads, direction, wire, (low, down, high, up) in macro["pins"]:
        net = Net.create(cell, name)
        net.setExternal(True)
        net.setDirection(Net.Direction.IN if direction == "input" else Net.Direction.OUT)
        middle, west = y + (down + up) / 2, low <= 0
        if leads:
            _lead(
                net,
                layer,
                request,
                wire,
                up - down,
                direction == "input",
                edges[0 if west else 1],
                -1 if west else 1,
                middle,
                _track(layer(wire), bottom + middle) - bottom,
            )
        else:  # every pin must have a piece to be met; this one stays inside
            NetExternalComponents.setExternal(_bar(net, layer(wire), middle, up - down, x + low, x + high))
    cell.setTerminalNetlist(True)


def _lead(net, layer, request, wire, width, hop, edge, way, y, track):
    """From a pin at ``y`` on the edge at x = ``edge`` out of the block, which is ``way`` (-1 or 1), on to the track."""

    def bar(at, begin, end):
        return _bar(net, layer(wire), at, width, *sorted(edge + way * value for value in (begin, end)))

    pad = max(cut["size_um"] + 2 * cut["enclosure_um"] for cut in request["cuts"])
    up, down = (pads * pad for pads in HOP_PADS)
    bend, free = 0.0, request["row_um"]
    if hop:
        bar(y, 0, up + pad)
        bend = down - pad
        _hop(net, layer, request, wire, y, [edge + way * up, edge + way * down], pad)
    bar(y, bend, bend + PAD_LENGTH * pad)
    bar(track, bend, free + MEET_UM[1])
    NetExternalComponents.setExternal(bar(track, free + MEET_UM[0], free + MEET_UM[1]))


def _hop(net, layer, request, wire, y, ends, pad):
    """From ``wire`` up to the highest at both ``ends`` (x), and that wire between them."""
    names = [made["name"] for made in request["wires"]]
    first = names.index(wire)
    for x in ends:
        for name in names[first + 1 : -1]:
            Pad.create(net, layer(name), _around(x, y, PAD_LENGTH * pad, pad))
        for cut in request["cuts"][first:]:
            Pad.create(net, layer(cut["name"]), _around(x, y, cut["size_um"], cut["size_um"]))
    half = PAD_LENGTH * pad / 2
    _bar(net, layer(names[-1]), y, pad, min(ends) - half, max(ends) + half)


def _around(x, y, width, height):
    return _box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


def _box(left, bottom, right, top):
    return Box(*map(_units, (left, bottom, right, top)))


def _bar(net, layer, y, width, begin, end):
    return Horizontal.create(net, layer, *map(_units, (y, width, begin, end)))


def _units(um):
    """u() cuts off: what is a hair less than a number on the grid would be off it."""
    return u(round(um, 4) + 1e-6)


def _track(layer, y):
    """y (um) of the track of ``layer`` in the core nearest to ``y``."""
    gauge = CRL.AllianceFramework.get().getRoutingGauge(GAUGE).getLayerGauge(layer)
    pitch, offset = gauge.getPitch(), gauge.getOffset()
    return (round((u(y) - offset) / pitch) * pitch + offset) / u(1.0)


def fix_macros(cell, request):
    """Put the instances where they belong."""
    macros = {macro["name"]: macro for macro in request["macros"]}
    UpdateSession.open()
    for instance in cell.getInstances():
        macro = macros.get(instance.getMasterCell().getName())
        if macro:
            left, bottom, *_ = macro["outer"]
            instance.setTransformation(Transformation(u(left), u(bottom), Transformation.Orientation.ID))
            instance.setPlacementStatus(Instance.PlacementStatus.FIXED)
    UpdateSession.close()
