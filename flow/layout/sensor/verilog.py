"""The die as Verilog: its blocks and what joins them."""

import re

from .plan import CORE, SUPPLIES


def buses(names):
    """dict bus -> bits, None for a single wire, of names as 'a' and 'a[3]', in their order."""
    found = {}
    for name in names:
        base, bit = re.fullmatch(r"(\w+)(?:\[(\d+)\])?", name).groups()
        found[base] = None if bit is None else max(found.get(base, 0), int(bit) + 1)
    return found


def top(name, blocks, nets):
    """The module's text, behind those of the analog blocks as black boxes; the chip's is another file's.

    blocks: dict name -> Block. nets: dict net -> pairs (block, pin), each pin of the net's name; ('die', net) is a
    port. Supplies are left out, as in the chip's own netlist.
    """
    nets = {net: ends for net, ends in nets.items() if net not in SUPPLIES}
    ports = buses(net for net, ends in nets.items() if any(block == "die" for block, _ in ends))
    lines = []
    for block in blocks.values():
        if block.name != CORE:
            pins = [pin for pin in block.pins if pin not in SUPPLIES]
            lines += [
                "(* blackbox *)",
                *_module(
                    block.cell, {bus: (bits, block.directions[_first(bus, bits)]) for bus, bits in buses(pins).items()}
                ),
                "endmodule",
                "",
            ]
    lines += _module(name, {bus: (bits, _way(nets[_first(bus, bits)], blocks)) for bus, bits in ports.items()})
    lines += [f"  wire {_range(bits)}{bus};" for bus, bits in buses(nets).items() if bus not in ports]
    for block in blocks.values():
        pins = (f".{bus}({bus})" for bus in buses(pin for pin in block.pins if pin not in SUPPLIES))
        lines.append(f"  {block.cell} {block.name} ({', '.join(pins)});")
    return "\n".join([*lines, "endmodule", ""])


def _module(name, ports):
    """Lines of a module's head. ports: dict bus -> (bits, direction)."""
    return [
        f"module {name} ({', '.join(ports)});",
        *(f"  {way} {_range(bits)}{bus};" for bus, (bits, way) in ports.items()),
    ]


def _first(bus, bits):
    return bus if bits is None else f"{bus}[0]"


def _range(bits):
    return "" if bits is None else f"[{bits - 1}:0] "


def _way(ends, blocks):
    """'output' where a block drives the die's pin, else 'input'."""
    return (
        "output" if any(blocks[block].directions[pin] == "output" for block, pin in ends if block != "die") else "input"
    )
