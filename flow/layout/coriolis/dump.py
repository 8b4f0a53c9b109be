"""Hurricane's database after routing as plain lists."""

from typing import Any

from coriolis.Hurricane import Contact, DbU, Horizontal, Pin, Vertical


def _um(value: int) -> float:
    return round(DbU.toPhysical(value, DbU.UnitPowerMicro), 4)


def instances(cell: Any) -> list[list[Any]]:
    """[name, master, x_um, y_um, orientation, {pin: net}] of every instance."""
    made = []
    for instance in cell.getInstances():
        where = instance.getTransformation()
        plugs = [plug for plug in instance.getPlugs() if plug.getNet() is not None]
        pins = {plug.getMasterNet().getName(): plug.getNet().getName() for plug in plugs}
        place = _um(where.getTx()), _um(where.getTy()), str(where.getOrientation())
        made.append([instance.getName(), instance.getMasterCell().getName(), *place, pins])
    return made


def segments(cell: Any) -> dict[str, list[list[Any]]]:
    """[layer, length_um, width_um] of the segments and vias of each signal net.

    The layer of a via is named after the layers that it joins, its length and width are 0.
    """
    nets = {}
    for net in cell.getNets():
        if not net.isSupply():
            nets[net.getName()] = [made for made in map(_segment, net.getComponents()) if made]
    return nets


def _segment(component: Any) -> list[Any] | None:
    layer = component.getLayer().getName() if component.getLayer() is not None else ".block"
    if layer.endswith(".block"):  # the router's blockages
        return None
    if isinstance(component, (Horizontal, Vertical)):
        dx, dy = component.getTargetX() - component.getSourceX(), component.getTargetY() - component.getSourceY()
        return [layer, _um(abs(dx) + abs(dy)), _um(component.getWidth())]
    return [layer, 0, 0] if isinstance(component, Contact) and "_" in layer else None


def shapes(cell: Any) -> dict[str, dict[str, list[Any]]]:
    """Where each signal net is, for rerouting.

    Lists of 'segments' [layer, left, bottom, right, top], 'vias' [layer, x, y] and 'pins': of every cell and port on
    the net the boxes, as segments, of which any one is to be met.
    """
    nets = {}
    for net in cell.getNets():
        if net.isSupply():
            continue
        made = nets[net.getName()] = {"segments": [], "vias": [], "pins": []}
        for component in net.getComponents():
            if isinstance(component, Pin):
                made["pins"].append([_box(component.getLayer(), component.getBoundingBox())])
            elif isinstance(component, (Horizontal, Vertical)) and _segment(component):
                made["segments"].append(_box(component.getLayer(), component.getBoundingBox()))
            elif isinstance(component, Contact) and _segment(component):
                made["vias"].append([component.getLayer().getName(), _um(component.getX()), _um(component.getY())])
        for plug in net.getPlugs():
            place = plug.getInstance().getTransformation()
            parts = plug.getMasterNet().getExternalComponents()
            made["pins"].append([_box(part.getLayer(), place.getBox(part.getBoundingBox())) for part in parts])
    return nets


def _box(layer: Any, box: Any) -> list[Any]:
    return [layer.getName(), *map(_um, (box.getXMin(), box.getYMin(), box.getXMax(), box.getYMax()))]
