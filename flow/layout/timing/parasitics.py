"""Parasitics of a net's segments, and the SPEF of a netlist.

Each segment counts with its area and its two long edges to the substrate, each via with its resistance. There is no
coupling between segments, and a net is one T: half of its whole resistance on either side of its capacitance, which is
more than any single path of a branched net has.
"""

import json
from collections.abc import Container, Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from flow.layout.netlist.netlist import OUTPUT_PINS, Netlist
from platforms.coriolis import CoriolisPlatform


class Parasitics(NamedTuple):
    """Capacitance to the substrate and resistance of a net."""

    femtofarad: float
    ohm: float


def parasitics(segments: Iterable[tuple[str, float, float]], tech: CoriolisPlatform) -> Parasitics:
    """Parasitics of a net's ``segments``: (layer, length_um, width_um), a via with length 0."""
    metals = {metal.name: metal for metal in tech.metals}
    names = [metal.name for metal in tech.metals]
    vias = {f"{low}_{via.name}_{high}": via for low, via, high in zip(names, tech.vias, names[1:])}
    attofarad = ohm = 0.0
    for layer, length, width in segments:
        if layer in vias:
            ohm += vias[layer].ohm
        elif layer in metals and length:
            metal = metals[layer]
            attofarad += length * (width * metal.area_af_um2 + 2 * metal.fringe_af_um)
            ohm += length / width * metal.sheet_ohm
    return Parasitics(attofarad / 1000, ohm)


def extract(netlist: Netlist, placement: Path, tech: CoriolisPlatform) -> dict[str, Parasitics]:
    """Parasitics of the nets of ``netlist`` from the segments in the file ``placement``, by net."""
    nets = {net for instance in netlist.instances for net in instance.pins.values()}
    segments = json.loads(placement.read_text())["segments"]
    return {net: parasitics(parts, tech) for net, parts in segments.items() if net in nets}


def spef(netlist: Netlist, nets: Mapping[str, tuple[float, float]]) -> str:
    """Text of the SPEF. nets: net -> (fF, ohm)."""
    pins: dict[str, list[tuple[str, str]]] = {}
    for instance in netlist.instances:
        for pin, net in instance.pins.items():
            pins.setdefault(net, []).append((f"{_name(instance.name, ())}:{pin}", pin))
    ports = {net: port.direction for port in netlist.ports for net in port.bits()}
    lines = ['*SPEF "IEEE 1481-1998"', f'*DESIGN "{netlist.name}"', '*DATE ""', '*VENDOR ""', '*PROGRAM "talbot"']
    lines += ['*VERSION ""', '*DESIGN_FLOW ""', "*DIVIDER /", "*DELIMITER :", "*BUS_DELIMITER [ ]"]
    lines += ["*T_UNIT 1 NS", "*C_UNIT 1 FF", "*R_UNIT 1 OHM", "*L_UNIT 1 HENRY"]
    for net, (femtofarad, ohm) in sorted(nets.items()):
        ends = [f"*I {pin} {'O' if name in OUTPUT_PINS else 'I'}" for pin, name in pins.get(net, [])]
        if net in ports:
            ends.append(f"*P {_name(net, ports)} {'I' if ports[net] == 'input' else 'O'}")
        center = f"{_name(net, ports)}:1"
        branches = (f"{k} {end.split()[1]} {center} {max(ohm / 2, 0.001):.3f}" for k, end in enumerate(ends, 1))
        lines += ["", f"*D_NET {_name(net, ports)} {femtofarad:.4f}", "*CONN", *ends]
        lines += ["*CAP", f"1 {center} {femtofarad:.4f}", "*RES", *branches, "*END"]
    return "\n".join(lines) + "\n"


def _name(name: str, ports: Container[str]) -> str:
    """Escape a name as SPEF does: a backslash before everything but letters, digits and _.

    Brackets of a port's bit (a name in ``ports``) stay: a bracket in the name of a register is a letter of it.
    """
    letters = "_[]" if name in ports else "_"
    return "".join(c if c.isalnum() or c in letters else f"\\{c}" for c in name)
