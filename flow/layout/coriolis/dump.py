"""What is in Hurricane's database after routing, as plain lists."""

from coriolis.Hurricane import Contact, DbU, Horizontal, Pin, Vertical


def _um(value):
    return round(DbU.toPhysical(value, DbU.UnitPowerMicro), 4)


def instances(cell):
    """[name, master, x_um, y_um, orientation, {pin: net}] of every instance."""
    made = []
    for instance in cell.getInstances():
        where = instance.getTransformation()
        pins = {
            plug.getMasterNet().getName(): plug.getNet().getName()
            for plug in instance.getPlugs()
            if plug.getNet() is not None
        }
        made.append(
            [
                instance.getName(),
                instance.getMasterCell().getName(),
                _um(where.getTx()),
                _um(where.getTy()),
                str(where.getOrientation()),
                pins,
            ]
        )
    return made


def wires(cell):
    """What each signal net is made of: dict net -> [[layer, length_um, width_um], ...]; of a contact, whose layer is
    named after the wires that it joins, both are 0."""
    nets = {}
    for net in cell.getNets():
        if not net.isSupply():
            nets[net.getName()] = [made for made in map(_wire, net.getComponents()) if made]
    return nets


def _wire(component):
    layer = component.getLayer().getName() if component.getLayer() is not None else ".block"
    if layer.endswith(".block"):  # the router's own
        return None
    if isinstance(component, (Horizontal, Vertical)):
        length = abs(component.getTargetX() - component.getSourceX()) + abs(
            component.getTargetY() - component.getSourceY()
        )
        return [layer, _um(length), _um(component.getWidth())]
    return [layer, 0, 0] if isinstance(component, Contact) and "_" in layer else None


def shapes(cell):
    """Where each signal net is, for who routes one anew: dict net -> lists of 'wires' [layer, left, bottom, right, top],
    'cuts' [layer, x, y], 'pins' (of every cell and port on the net the boxes, as wires, of which any one is to be met).
    """
    nets = {}
    for net in cell.getNets():
        if net.isSupply():
            continue
        made = nets[net.getName()] = {"wires": [], "cuts": [], "pins": []}
        for component in net.getComponents():
            if isinstance(component, Pin):
                made["pins"].append([_box(component.getLayer(), component.getBoundingBox())])
            elif isinstance(component, (Horizontal, Vertical)) and _wire(component):
                made["wires"].append(_box(component.getLayer(), component.getBoundingBox()))
            elif isinstance(component, Contact) and _wire(component):
                made["cuts"].append([component.getLayer().getName(), _um(component.getX()), _um(component.getY())])
        for plug in net.getPlugs():
            place = plug.getInstance().getTransformation()
            made["pins"].append(
                [
                    _box(part.getLayer(), place.getBox(part.getBoundingBox()))
                    for part in plug.getMasterNet().getExternalComponents()
                ]
            )
    return nets


def _box(layer, box):
    return [layer.getName(), *map(_um, (box.getXMin(), box.getYMin(), box.getXMax(), box.getYMax()))]
