"""The die as Verilog: its blocks and what joins them."""

import re


def buses(names):
    """dict bus -> bits, None for a single wire, of names as 'a' and 'a[3]', in their order."""
    found = {}
    for name in names:
        base, bit = re.fullmatch(r"(\w+)(?:\[(\d+)\])?", name).groups()
        found[base] = None if bit is None else max(found.get(base, 0), int(bit) + 1)
    return found


def top(name, blocks, nets):
    """The module's text, and those of the analog blocks without insides; the chip's is another file's.

    blocks: dict name -> Block. nets: dict net -> pairs (block, pin), each pin of the net's name; ('die', net) is a port.
    """
    ports = buses(net for net, ends in nets.items() if any(block == "die" for block, _ in ends))
    wires = {bus: bits for bus, bits in buses(nets).items() if bus not in ports}
    lines = [f"module {name} ({', '.join(ports)});"]
    lines += [f"  {_way(bus, bits, nets, blocks)} {_range(bits)}{bus};" for bus, bits in ports.items()]
    lines += [f"  wire {_range(bits)}{bus};" for bus, bits in wires.items()]
    for block in blocks.values():
        pins = ", ".join(f".{bus}({bus})" for bus in buses(block.pins))
        lines.append(f"  {block.cell} {block.name} ({pins});")
    lines += ["endmodule", ""]
    return "\n".join(lines)


def _range(bits):
    return "" if bits is None else f"[{bits - 1}:0] "


def _way(bus, bits, nets, blocks):
    """'output' where a block drives the port, 'inout' for a supply, else 'input'."""
    ends = nets[bus if bits is None else f"{bus}[0]"]
    ways = {blocks[block].directions[pin] for block, pin in ends if block != "die"}
    return "output" if "output" in ways else "inout" if "inout" in ways else "input"
