"""Macros: cells with pins and obstructions, whose instances are fixed where the floorplan puts them.

A segment leads from each pin out of the macro, to where the router meets it. That to an input has an antenna jumper on
the top layer: until that layer is made, nothing outside is joined to the gate inside.
"""

from typing import Any

from coriolis import CRL, Hurricane  # pyright: ignore[reportAttributeAccessIssue]  # compiled, without stubs
from coriolis.helpers import u

GAUGE = "StdCellLib"
JUMPER_PADS = 2.0, 6.5  # from the edge of the macro, in pads: where the jumper goes up, where it comes down
PAD_LENGTH = 2.0  # of a pad between two vias by its width: required by the least area of a layer
MEET_UM = 0.8, 2.4  # beyond the halo of the macro: the piece that the router meets

Request = dict[str, Any]  # see the step place


def make_macros(request: Request) -> None:
    """Draw a cell for each of the request's macros, before the netlist that holds them is read."""
    if not request["macros"]:
        return
    database = Hurricane.DataBase.getDB()
    library = Hurricane.Library.create(database.getRootLibrary(), "Macros")
    Hurricane.UpdateSession.open()
    for macro in request["macros"]:
        _make(Hurricane.Cell.create(library, macro["name"]), macro, request)
    Hurricane.UpdateSession.close()
    CRL.AllianceFramework.get().wrapLibrary(library, 0)


def _make(cell: Any, macro: dict[str, Any], request: Request) -> None:
    """Draw it; its origin is that of its outer box."""
    left, bottom, right, top = macro["outer"]
    x, y, row = macro["x_um"] - left, macro["y_um"] - bottom, request["row_um"]
    edges = x, x + macro["width_um"]
    cell.setAbutmentBox(Hurricane.Box(0, 0, u(right - left), u(top - bottom)))
    obstacles = Hurricane.Net.create(cell, "*")
    low, high = y - request["over_um"], y + macro["height_um"] + request["over_um"]
    solid = _box(edges[0] - row, low, edges[1] + row, high)
    for metal in request["metals"]:
        Hurricane.Pad.create(obstacles, _layer(f"{metal['name']}.block"), solid)
    for name, leads, direction, metal, (low, down, high, up) in macro["pins"]:
        net = Hurricane.Net.create(cell, name)
        net.setExternal(True)
        net.setDirection(Hurricane.Net.Direction.IN if direction == "input" else Hurricane.Net.Direction.OUT)
        middle, west = y + (down + up) / 2, low <= 0
        if leads:
            edge, way = (edges[0], -1) if west else (edges[1], 1)
            track = _track(_layer(metal), bottom + middle) - bottom
            _lead(net, request, metal, up - down, direction == "input", edge, way, middle, track)
        else:  # every pin must have a piece for the router; this one stays inside
            Hurricane.NetExternalComponents.setExternal(_bar(net, _layer(metal), middle, up - down, x + low, x + high))
    cell.setTerminalNetlist(True)


def _lead(
    net: Any, request: Request, metal: str, width: float, jumper: bool, edge: float, way: int, y: float, track: float
) -> None:
    """From a pin at ``y`` on the edge at x = ``edge`` out of the macro, which is ``way`` (-1 or 1), on to the track."""

    def bar(at: float, begin: float, end: float) -> Any:
        return _bar(net, _layer(metal), at, width, *sorted(edge + way * value for value in (begin, end)))

    pad = max(via["size_um"] + 2 * via["enclosure_um"] for via in request["vias"])
    up, down = (pads * pad for pads in JUMPER_PADS)
    bend, free = 0.0, request["row_um"]
    if jumper:
        bar(y, 0, up + pad)
        bend = down - pad
        _jumper(net, request, metal, y, [edge + way * up, edge + way * down], pad)
    bar(y, bend, bend + PAD_LENGTH * pad)
    bar(track, bend, free + MEET_UM[1])
    Hurricane.NetExternalComponents.setExternal(bar(track, free + MEET_UM[0], free + MEET_UM[1]))


def _jumper(net: Any, request: Request, metal: str, y: float, ends: list[float], pad: float) -> None:
    """From ``metal`` up to the top layer at both ``ends`` (x), and a segment of that between them."""
    names = [made["name"] for made in request["metals"]]
    first = names.index(metal)
    for x in ends:
        for name in names[first + 1 : -1]:
            Hurricane.Pad.create(net, _layer(name), _around(x, y, PAD_LENGTH * pad, pad))
        for via in request["vias"][first:]:
            Hurricane.Pad.create(net, _layer(via["name"]), _around(x, y, via["size_um"], via["size_um"]))
    half = PAD_LENGTH * pad / 2
    _bar(net, _layer(names[-1]), y, pad, min(ends) - half, max(ends) + half)


def _layer(name: str) -> Any:
    return Hurricane.DataBase.getDB().getTechnology().getLayer(name)


def _around(x: float, y: float, width: float, height: float) -> Any:
    return _box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


def _box(left: float, bottom: float, right: float, top: float) -> Any:
    return Hurricane.Box(*map(_units, (left, bottom, right, top)))


def _bar(net: Any, layer: Any, y: float, width: float, begin: float, end: float) -> Any:
    return Hurricane.Horizontal.create(net, layer, *map(_units, (y, width, begin, end)))


def _units(um: float) -> int:
    """Database units. u() truncates: a number just below one on the grid would be off it."""
    return u(round(um, 4) + 1e-6)


def _track(layer: Any, y: float) -> float:
    """y (um) of the track of ``layer`` in the core nearest to ``y``."""
    gauge = CRL.AllianceFramework.get().getRoutingGauge(GAUGE).getLayerGauge(layer)
    pitch, offset = gauge.getPitch(), gauge.getOffset()
    return (round((u(y) - offset) / pitch) * pitch + offset) / u(1.0)


def fix_macros(cell: Any, request: Request) -> None:
    """Fix the macros' instances in their places."""
    macros = {macro["name"]: macro for macro in request["macros"]}
    Hurricane.UpdateSession.open()
    for instance in cell.getInstances():
        macro = macros.get(instance.getMasterCell().getName())
        if macro:
            left, bottom, *_ = macro["outer"]
            place = Hurricane.Transformation(u(left), u(bottom), Hurricane.Transformation.Orientation.ID)
            instance.setTransformation(place)
            instance.setPlacementStatus(Hurricane.Instance.PlacementStatus.FIXED)
    Hurricane.UpdateSession.close()
