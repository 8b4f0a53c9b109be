"""What is in Hurricane's database after routing, as plain lists."""

from coriolis.Hurricane import Contact, DbU, Horizontal, Vertical


def _um(value):
    return round(DbU.toPhysical(value, DbU.UnitPowerMicro), 4)


def instances(cell):
    """[name, master, x_um, y_um, orientation, {pin: net}] of every instance."""
    made = []
    for instance in cell.getInstances():
        where = instance.getTransformation()
        pins = {plug.getMasterNet().getName(): plug.getNet().getName()
                for plug in instance.getPlugs() if plug.getNet() is not None}
        made.append([instance.getName(), instance.getMasterCell().getName(), _um(where.getTx()), _um(where.getTy()),
                     str(where.getOrientation()), pins])
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
    if layer.endswith(".block"):            # the router's own
        return None
    if isinstance(component, (Horizontal, Vertical)):
        length = abs(component.getTargetX() - component.getSourceX()) + abs(component.getTargetY()
                                                                            - component.getSourceY())
        return [layer, _um(length), _um(component.getWidth())]
    return [layer, 0, 0] if isinstance(component, Contact) and "_" in layer else None
