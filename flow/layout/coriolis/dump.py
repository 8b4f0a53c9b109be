"""Hurricane's database after placement as plain lists."""

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


def shapes(cell: Any) -> dict[str, dict[str, list[Any]]]:
    """Where each signal net is, for routing.

    Lists of 'segments' [layer, left, bottom, right, top] and 'vias' [layer, x, y], of the clock tree's trunk alone,
    and 'ports', boxes as segments.
    """
    nets = {}
    for net in cell.getNets():
        if net.isSupply():
            continue
        made = nets[net.getName()] = {"segments": [], "vias": [], "ports": []}
        for component in net.getComponents():
            name = component.getLayer().getName() if component.getLayer() is not None else ".block"
            if isinstance(component, Pin):
                made["ports"].append(_box(component.getLayer(), component.getBoundingBox()))
            elif isinstance(component, (Horizontal, Vertical)) and not name.endswith(".block"):
                made["segments"].append(_box(component.getLayer(), component.getBoundingBox()))
            elif isinstance(component, Contact) and "_" in name:
                made["vias"].append([name, _um(component.getX()), _um(component.getY())])
    return nets


def masters(cell: Any) -> dict[str, dict[str, list[Any]]]:
    """Of every cell of the libraries that ``cell`` uses, by pin, the boxes of which any one is to be met."""
    libraries = {instance.getMasterCell().getLibrary().getName(): instance for instance in cell.getInstances()}
    made = {}
    for instance in libraries.values():
        for master in instance.getMasterCell().getLibrary().getCells():
            nets = [net for net in master.getNets() if net.isExternal() and not net.isSupply()]
            made[master.getName()] = {
                net.getName(): [_box(part.getLayer(), part.getBoundingBox()) for part in net.getExternalComponents()]
                for net in nets
            }
    return made


def _box(layer: Any, box: Any) -> list[Any]:
    return [layer.getName(), *map(_um, (box.getXMin(), box.getYMin(), box.getXMax(), box.getYMax()))]
