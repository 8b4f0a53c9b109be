"""Errors of a netlist, each reported by name before anything runs."""

from collections.abc import Container, Mapping
from typing import NoReturn

from talbot.cells.netlist.spice import Netlist
from talbot.models.parameters import ParameterError


def check(netlist: Netlist, models: Container[str], rails: Mapping[str, int]) -> None:
    """Raise ParameterError for the first error of ``netlist``.

    models: the device models of the process. rails: supply and bulk ports and their levels; the netlist needs one at
    least of each level.
    """
    if not netlist.transistors:
        _fail(netlist, "it has no transistor")
    for level in (1, 0):
        same = [rail for rail, at in rails.items() if at == level]
        if not set(same) & set(netlist.ports):
            _fail(netlist, f"port {' or '.join(same)} is missing; it has {', '.join(netlist.ports)}")
    twice = sorted({port for port in netlist.ports if netlist.ports.count(port) > 1})
    if twice:
        _fail(netlist, f"ports: duplicate name {twice[0]}")
    names = [t.name for t in netlist.transistors]
    for t in netlist.transistors:
        if t.model not in models:
            _fail(netlist, f"transistor {t.name} has model {t.model}, which the process does not have")
        if not (t.size.get("w", 0) > 0 and t.size.get("l", 0) > 0):
            _fail(netlist, f"transistor {t.name} must have w and l above 0")
        if names.count(t.name) > 1:
            _fail(netlist, f"transistors: duplicate name {t.name}")
    for passive in (*netlist.capacitors, *netlist.resistors):
        if passive.value < 0:
            _fail(netlist, f"{passive.name} must be 0 or more")
    _connected(netlist)


def _connected(netlist: Netlist) -> None:
    """Raise ParameterError unless every gate is driven and every port is used."""
    driven = set(netlist.ports)
    for t in netlist.transistors:
        driven |= {t.drain, t.source}
    joined = [{p.a, p.b} for p in netlist.resistors]
    while grown := [ends for ends in joined if ends & driven and not ends <= driven]:
        driven = driven.union(*grown)
    used = set().union(*joined)
    for t in netlist.transistors:
        used |= {t.drain, t.gate, t.source, t.bulk}
        if t.gate not in driven:
            _fail(netlist, f"the gate of {t.name} is floating: nothing drives node {t.gate}")
    for port in netlist.ports:
        if port not in used:
            _fail(netlist, f"port {port} is connected to nothing")


def _fail(netlist: Netlist, why: str) -> NoReturn:
    raise ParameterError(f"netlist = {netlist.name}: {why}")
