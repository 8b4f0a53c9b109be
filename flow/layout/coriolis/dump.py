"""What is in Hurricane's database after routing, as plain lists."""

from coriolis.Hurricane import DbU, Segment


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


def components(cell):
    """Length (um) of every signal net by layer, and its cuts: dict net -> {layer: um}."""
    nets = {}
    for net in cell.getNets():
        if net.isSupply():
            continue
        by_layer = nets.setdefault(net.getName(), {})
        for component in net.getComponents():
            if isinstance(component, Segment):
                name = component.getLayer().getName()
                by_layer[name] = round(by_layer.get(name, 0) + _length(component), 4)
    return nets


def _length(segment):
    """Between the ends of the axis, in um."""
    return abs(_um(segment.getTargetX()) - _um(segment.getSourceX())) + \
        abs(_um(segment.getTargetY()) - _um(segment.getSourceY()))
