"""What is wrong with a netlist is said by name before anything runs."""

from models.parameters import ParameterError


def check(netlist, models, rails, ports=None):
    """Raise ParameterError for the first error of ``netlist`` (a Netlist).

    models: names of the device models that the process has. rails: names of supply and bulk ports that must be there.
    ports: the set of signal ports that the cell's abstract has, where there is one.
    """
    fail = _failure(netlist)
    if not netlist.transistors:
        fail("it has no transistor")
    for rail in rails:
        if rail not in netlist.ports:
            fail(f"port {rail} is missing; it has {', '.join(netlist.ports)}")
    signals = [p for p in netlist.ports if p not in rails]
    if ports is not None and set(signals) != set(ports):
        fail(f"ports {' '.join(sorted(signals))} must be {' '.join(sorted(ports))}")
    names = [t.name for t in netlist.transistors]
    for t in netlist.transistors:
        if t.model not in models:
            fail(f"transistor {t.name} has model {t.model}, which the process does not have")
        if not (t.size.get("w", 0) > 0 and t.size.get("l", 0) > 0):
            fail(f"transistor {t.name} must have w and l above 0")
        if names.count(t.name) > 1:
            fail(f"two transistors have the name {t.name}")
    _connected(netlist, fail)


def _connected(netlist, fail):
    """Every gate is driven, every port is used, every node has at least two connections."""
    driven = set(netlist.ports)
    for t in netlist.transistors:
        driven |= {t.drain, t.source}
    wires = [{p.a, p.b} for p in netlist.resistors]
    while grown := [w for w in wires if w & driven and not w <= driven]:
        for wire in grown:
            driven |= wire
    used = set()
    for t in netlist.transistors:
        used |= {t.drain, t.gate, t.source, t.bulk}
        if t.gate not in driven:
            fail(f"the gate of {t.name} is floating: nothing drives node {t.gate}")
    for wire in wires:
        used |= wire
    for port in netlist.ports:
        if port not in used:
            fail(f"port {port} is connected to nothing")


def _failure(netlist):
    def fail(why):
        raise ParameterError(f"netlist = {netlist.name}: {why}")
    return fail
