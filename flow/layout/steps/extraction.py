"""Capacitance and resistance of every net, from the wires that the router drew, as SPEF.

Each wire counts with its area and its two long edges to the substrate, each cut with its resistance. There is no
coupling between wires in it, and a net is one T: half of its whole resistance on either side of its capacitance,
which is more than any single path of a branched net has.
"""

import json
from dataclasses import dataclass

from base.steps import Step
from platforms.coriolis import process

from ..netlist import netlist as netlist_module
from ..netlist.netlist import OUTPUT_PINS, Netlist


@dataclass(frozen=True)
class ExtractionParameters:
    """pdk: process."""

    pdk: str = "sky130"


class Extraction(Step):
    """From lengths and widths in the router's database and the process's coefficients per layer."""

    name = "extraction"
    inputs = {
        "netlist": "place_route.netlist",
        "placement": "reroute.placement",
        "platform": "platform",
        "liberty": "library.liberty",
    }
    outputs = {"spef": "wires.spef"}
    Parameters = ExtractionParameters
    metrics = {"wire_pf": "pF", "largest_ff": "fF", "largest_ohm": "Ohm"}
    uses = (netlist_module,)

    def run(self, inputs, outputs):
        known, _ = process(self.parameters.pdk)
        netlist = Netlist.read(inputs["netlist"])
        wires = json.loads(inputs["placement"].read_text())["wires"]
        there = {net for instance in netlist.instances for net in instance.pins.values()}
        nets = {net: parasitics(parts, known) for net, parts in wires.items() if net in there}
        outputs["spef"].write_text(spef(netlist, nets))
        return {
            "wire_pf": round(sum(c for c, _ in nets.values()) / 1000, 3),
            "largest_ff": round(max(c for c, _ in nets.values()), 2),
            "largest_ohm": round(max(r for _, r in nets.values()), 1),
        }


def parasitics(parts, known):
    """(fF, Ohm) of a net. parts: [[layer, length_um, width_um], ...], a contact with length 0."""
    wires = {wire.name: wire for wire in known.wires}
    cuts = {f"{known.wires[k].name}_{cut.name}_{known.wires[k + 1].name}": cut for k, cut in enumerate(known.cuts)}
    attofarad = ohm = 0.0
    for layer, length, width in parts:
        if layer in cuts:
            ohm += cuts[layer].ohm
        elif layer in wires and length:
            wire = wires[layer]
            attofarad += length * (width * wire.area_af_um2 + 2 * wire.edge_af_um)
            ohm += length / width * wire.ohm
    return attofarad / 1000, ohm


def spef(netlist, nets):
    """The SPEF file as text. nets: dict net -> (fF, Ohm)."""
    pins = {}
    for instance in netlist.instances:
        for pin, net in instance.pins.items():
            pins.setdefault(net, []).append((f"{_name(instance.name, ())}:{pin}", pin))
    ports = {net: port.direction for port in netlist.ports for net in port.bits()}
    lines = [
        '*SPEF "IEEE 1481-1998"',
        f'*DESIGN "{netlist.name}"',
        '*DATE ""',
        '*VENDOR ""',
        '*PROGRAM "talbot"',
        '*VERSION ""',
        '*DESIGN_FLOW ""',
        "*DIVIDER /",
        "*DELIMITER :",
        "*BUS_DELIMITER [ ]",
        "*T_UNIT 1 NS",
        "*C_UNIT 1 FF",
        "*R_UNIT 1 OHM",
        "*L_UNIT 1 HENRY",
    ]
    for net, (femtofarad, ohm) in sorted(nets.items()):
        ends = [f"*I {pin} {'O' if name in OUTPUT_PINS else 'I'}" for pin, name in pins.get(net, [])]
        if net in ports:
            ends.append(f"*P {_name(net, ports)} {'I' if ports[net] == 'input' else 'O'}")
        center = f"{_name(net, ports)}:1"
        branches = (f"{k} {end.split()[1]} {center} {max(ohm / 2, 0.001):.3f}" for k, end in enumerate(ends, 1))
        lines += [
            "",
            f"*D_NET {_name(net, ports)} {femtofarad:.4f}",
            "*CONN",
            *ends,
            "*CAP",
            f"1 {center} {femtofarad:.4f}",
            "*RES",
            *branches,
            "*END",
        ]
    return "\n".join(lines) + "\n"


def _name(name, ports):
    """As SPEF writes it: everything but letters, digits and _ behind a backslash, but for the brackets of a bus's bit
    (what is in ``ports``): a bracket in the name of a register is a letter of it."""
    letters = "_[]" if name in ports else "_"
    return "".join(c if c.isalnum() or c in letters else f"\\{c}" for c in name)
