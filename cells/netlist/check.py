"""What is wrong with a netlist is said by name before anything runs."""

from models.parameters import ParameterError


def check(netlist, models, rails):
    """Raise ParameterError for the first error of ``netlist`` (a Netlist).

    models: names of the device models that the process has. rails: name of a supply or bulk port -> its level, of which
    there must be one at least for each level.
    """
    fail = _failure(netlist)
    if not netlist.transistors:
        fail("it has no transistor")
    for level in (1, 0):
        same = [rail for rail, at in rails.items() if at == level]
        if not set(same) & set(netlist.ports):
            fail(f"port {' or '.join(same)} is missing; it has {', '.join(netlist.ports)}")
    twice = sorted({port for port in netlist.ports if netlist.ports.count(port) > 1})
    if twice:
        fail(f"two ports have the name {twice[0]}")
    names = [t.name for t in netlist.transistors]
    for t in netlist.transistors:
        if t.model not in models:
            fail(f"transistor {t.name} has model {t.model}, which the process does not have")
        if not (t.size.get("w", 0) > 0 and t.size.get("l", 0) > 0):
            fail(f"transistor {t.name} must have w and l above 0")
        if names.count(t.name) > 1:
            fail(f"two transistors have the name {t.name}")
    for passive in (*netlist.capacitors, *netlist.resistors):
        if passive.value < 0:
            fail(f"{passive.name} must be 0 or more")
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
