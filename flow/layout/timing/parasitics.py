"""Parasitics of a net's segments, and the SPEF of a netlist.

Each segment counts with its area and its two long edges to the substrate, each via with its resistance. There is no
coupling between segments, and a net is one T: half of its whole resistance on either side of its capacitance, which is
more than any single path of a branched net has.
"""

from flow.layout.netlist.netlist import OUTPUT_PINS


def parasitics(parts, known):
    """(fF, Ohm) of a net. parts: [[layer, length_um, width_um], ...], a contact with length 0."""
    wires = {wire.name: wire for wire in known.metals}
    cuts = {f"{known.metals[k].name}_{cut.name}_{known.metals[k + 1].name}": cut for k, cut in enumerate(known.vias)}
    attofarad = ohm = 0.0
    for layer, length, width in parts:
        if layer in cuts:
            ohm += cuts[layer].ohm
        elif layer in wires and length:
            wire = wires[layer]
            attofarad += length * (width * wire.area_af_um2 + 2 * wire.fringe_af_um)
            ohm += length / width * wire.sheet_ohm
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
