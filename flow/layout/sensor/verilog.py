"""The die as Verilog: its blocks and their nets."""

from collections.abc import Iterable, Mapping, Sequence

from talbot.flow.layout.sensor.plan import CORE, SUPPLIES, Block, Terminal
from talbot.flow.layout.sensor.ring import DIGITAL, OUTSIDE, Place

INSIDE = "inside"


def buses(names: Iterable[str]) -> dict[str, int | None]:
    """Bits of every bus, None for a scalar, of names as 'a' and 'a[3]', in their order."""
    found: dict[str, int | None] = {}
    for name in names:
        base, _, bit = name.removesuffix("]").partition("[")
        found[base] = max(found.get(base) or 0, int(bit) + 1) if bit else None
    return found


def top(name: str, blocks: Mapping[str, Block], nets: Mapping[str, Sequence[Terminal]], places: Iterable[Place]) -> str:
    """Text of the die's module, after those of what is inside of the pads, and of black boxes: analog blocks and pads.

    The chip's is in another file. nets: each pin has the net's name; ('die', net) is a pin to a pad. places: of the
    ring. Supplies are left out, as in the chip's own netlist.
    """
    pads = [place for place in places if "pad" in place.nets]
    inner = inside(f"{name}_{INSIDE}", blocks, nets)
    ports = buses(net for net, ends in nets.items() if any(block == "die" for block, _ in ends) and net not in SUPPLIES)
    lines, kinds = [], {}
    for place in pads:
        kinds[place.cell] = [pin for pin in place.nets if pin not in DIGITAL]
    for cell, pins in kinds.items():
        lines += ["(* blackbox *)", f"module {cell} ({', '.join(pins)});"]
        lines += [f"  {'output' if pin == 'p2c' else 'input' if pin == 'c2p' else 'inout'} {pin};" for pin in pins]
        lines += ["endmodule", ""]
    lines += _module(name, {OUTSIDE + bus: (bits, "inout") for bus, bits in ports.items()})
    lines += [f"  wire {_range(bits)}{bus};" for bus, bits in ports.items()]
    lines += [f"  {name}_{INSIDE} {INSIDE} ({', '.join(f'.{bus}({bus})' for bus in ports)});"]
    for place in pads:
        pins = (f".{pin}({net})" for pin, net in place.nets.items() if pin not in DIGITAL)
        lines.append(f"  {place.cell} \\{place.name}_cell ({', '.join(pins)});")
    return "\n".join([inner, *lines, "endmodule", ""])


def inside(name: str, blocks: Mapping[str, Block], nets: Mapping[str, Sequence[Terminal]]) -> str:
    """Text of the module inside of the pads, after those of the analog blocks as black boxes."""
    nets = {net: ends for net, ends in nets.items() if net not in SUPPLIES}
    ports = buses(net for net, ends in nets.items() if any(block == "die" for block, _ in ends))
    lines = []
    for block in blocks.values():
        if block.name != CORE:
            own = buses(pin for pin in block.pins if pin not in SUPPLIES)
            ways = {bus: (bits, block.directions[_first(bus, bits)]) for bus, bits in own.items()}
            lines += ["(* blackbox *)", *_module(block.cell, ways), "endmodule", ""]
    lines += _module(name, {bus: (bits, _way(nets[_first(bus, bits)], blocks)) for bus, bits in ports.items()})
    lines += [f"  wire {_range(bits)}{bus};" for bus, bits in buses(nets).items() if bus not in ports]
    for block in blocks.values():
        pins = (f".{bus}({bus})" for bus in buses(pin for pin in block.pins if pin not in SUPPLIES))
        lines.append(f"  {block.cell} {block.name} ({', '.join(pins)});")
    return "\n".join([*lines, "endmodule", ""])


def _module(name: str, ports: Mapping[str, tuple[int | None, str]]) -> list[str]:
    """Lines of a module's head. ports: bus -> (bits, direction)."""
    declared = [f"  {way} {_range(bits)}{bus};" for bus, (bits, way) in ports.items()]
    return [f"module {name} ({', '.join(ports)});", *declared]


def _first(bus: str, bits: int | None) -> str:
    return bus if bits is None else f"{bus}[0]"


def _range(bits: int | None) -> str:
    return "" if bits is None else f"[{bits - 1}:0] "


def _way(ends: Sequence[Terminal], blocks: Mapping[str, Block]) -> str:
    """Direction of the die's pin: 'output' where a block drives it, else 'input'."""
    driven = any(blocks[block].directions[pin] == "output" for block, pin in ends if block != "die")
    return "output" if driven else "input"
