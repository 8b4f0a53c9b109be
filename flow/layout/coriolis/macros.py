"""Macros: cells with pins and obstructions, whose instances are fixed where the floorplan puts them.

A segment leads from each pin out of the macro, to where the router meets it. That to an input has an antenna jumper on
the top layer: until that layer is made, nothing outside is joined to the gate inside.
"""

from typing import Any

from coriolis import CRL  # pyright: ignore[reportAttributeAccessIssue]  # compiled, without stubs
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
JUMPER_PADS = 2.0, 6.5  # from the edge of the macro, in pads: where the jumper goes up, where it comes down
PAD_LENGTH = 2.0  # of a pad between two vias by its width: required by the least area of a layer
MEET_UM = 0.8, 2.4  # beyond the halo of the macro: the piece that the router meets


def make_macros(request: dict[str, Any]) -> None:
    """Draw a cell for each of the request's macros, before the netlist that holds them is read."""
    if not request["macros"]:
        return
    database = DataBase.getDB()
    library = Library.create(database.getRootLibrary(), "Macros")
    UpdateSession.open()
    for macro in request["macros"]:
        _make(Cell.create(library, macro["name"]), macro, request)
    UpdateSession.close()
    CRL.AllianceFramework.get().wrapLibrary(library, 0)


def _make(cell: Any, macro: dict[str, Any], request: dict[str, Any]) -> None:
    """Draw it; its origin is that of its outer box."""
    layer = DataBase.getDB().getTechnology().getLayer
    left, bottom, right, top = macro["outer"]
    x, y, row = macro["x_um"] - left, macro["y_um"] - bottom, request["row_um"]
    edges = x, x + macro["width_um"]
    cell.setAbutmentBox(Box(0, 0, u(right - left), u(top - bottom)))
    obstacles = Net.create(cell, "*")
    low, high = y - request["over_um"], y + macro["height_um"] + request["over_um"]
    for metal in request["metals"]:
        Pad.create(obstacles, layer(f"{metal['name']}.block"), _box(edges[0] - row, low, edges[1] + row, high))
    for name, leads, direction, metal, (low, down, high, up) in macro["pins"]:
        net = Net.create(cell, name)
        net.setExternal(True)
        net.setDirection(Net.Direction.IN if direction == "input" else Net.Direction.OUT)
        middle, west = y + (down + up) / 2, low <= 0
        if leads:
            _lead(
                net,
                layer,
                request,
                metal,
                up - down,
                direction == "input",
                edges[0 if west else 1],
                -1 if west else 1,
                middle,
                _track(layer(metal), bottom + middle) - bottom,
            )
        else:  # every pin must have a piece for the router; this one stays inside
            NetExternalComponents.setExternal(_bar(net, layer(metal), middle, up - down, x + low, x + high))
    cell.setTerminalNetlist(True)


def _lead(
    net: Any,
    layer: Any,
    request: dict[str, Any],
    metal: str,
    width: float,
    jumper: bool,
    edge: float,
    way: int,
    y: float,
    track: float,
) -> None:
    """From a pin at ``y`` on the edge at x = ``edge`` out of the macro, which is ``way`` (-1 or 1), on to the track."""

    def bar(at: float, begin: float, end: float) -> Any:
        return _bar(net, layer(metal), at, width, *sorted(edge + way * value for value in (begin, end)))

    pad = max(via["size_um"] + 2 * via["enclosure_um"] for via in request["vias"])
    up, down = (pads * pad for pads in JUMPER_PADS)
    bend, free = 0.0, request["row_um"]
    if jumper:
        bar(y, 0, up + pad)
        bend = down - pad
        _jumper(net, layer, request, metal, y, [edge + way * up, edge + way * down], pad)
    bar(y, bend, bend + PAD_LENGTH * pad)
    bar(track, bend, free + MEET_UM[1])
    NetExternalComponents.setExternal(bar(track, free + MEET_UM[0], free + MEET_UM[1]))


def _jumper(net: Any, layer: Any, request: dict[str, Any], metal: str, y: float, ends: list[float], pad: float) -> None:
    """From ``metal`` up to the top layer at both ``ends`` (x), and a segment of that between them."""
    names = [made["name"] for made in request["metals"]]
    first = names.index(metal)
    for x in ends:
        for name in names[first + 1 : -1]:
            Pad.create(net, layer(name), _around(x, y, PAD_LENGTH * pad, pad))
        for via in request["vias"][first:]:
            Pad.create(net, layer(via["name"]), _around(x, y, via["size_um"], via["size_um"]))
    half = PAD_LENGTH * pad / 2
    _bar(net, layer(names[-1]), y, pad, min(ends) - half, max(ends) + half)


def _around(x: float, y: float, width: float, height: float) -> Any:
    return _box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


def _box(left: float, bottom: float, right: float, top: float) -> Any:
    return Box(*map(_units, (left, bottom, right, top)))


def _bar(net: Any, layer: Any, y: float, width: float, begin: float, end: float) -> Any:
    return Horizontal.create(net, layer, *map(_units, (y, width, begin, end)))


def _units(um: float) -> int:
    """Database units. u() truncates: a number just below one on the grid would be off it."""
    return u(round(um, 4) + 1e-6)


def _track(layer: Any, y: float) -> float:
    """y (um) of the track of ``layer`` in the core nearest to ``y``."""
    gauge = CRL.AllianceFramework.get().getRoutingGauge(GAUGE).getLayerGauge(layer)
    pitch, offset = gauge.getPitch(), gauge.getOffset()
    return (round((u(y) - offset) / pitch) * pitch + offset) / u(1.0)


def fix_macros(cell: Any, request: dict[str, Any]) -> None:
    """Fix the macros' instances in their places."""
    macros = {macro["name"]: macro for macro in request["macros"]}
    UpdateSession.open()
    for instance in cell.getInstances():
        macro = macros.get(instance.getMasterCell().getName())
        if macro:
            left, bottom, *_ = macro["outer"]
            instance.setTransformation(Transformation(u(left), u(bottom), Transformation.Orientation.ID))
            instance.setPlacementStatus(Instance.PlacementStatus.FIXED)
    UpdateSession.close()
