"""A flat netlist of library cells: from Yosys or from Coriolis's database, as Verilog, BLIF, SPICE or JSON."""

import json
import re
from dataclasses import asdict, dataclass
from pathlib import Path

from base.steps import StepError

SUPPLIES = ("vdd", "vss")
OUTPUT_PINS = ("q", "nq", "zero", "one", "sum", "carry")  # of the library's cells
REGISTER = "_reg"  # behind a register's name: its flip-flop


def register_names(path, top):
    """Every name of every register of the module ``top`` of Yosys's JSON, one of simple flip-flops: set."""
    module = json.loads(Path(path).read_text())["modules"][top]
    bits = {cell["connections"]["Q"][0] for cell in module["cells"].values() if "DFF" in cell["type"]}
    return {full for name, wire in module["netnames"].items() for bit, full in named_bits(name, wire) if bit in bits}


def named_bits(name, wire):
    """(bit, its full name) of a wire of Yosys's JSON."""
    for index, bit in enumerate(wire["bits"]):
        yield bit, name if len(wire["bits"]) == 1 else f"{name}[{index + wire.get('offset', 0)}]"


@dataclass(frozen=True)
class Port:
    """direction: 'input' or 'output'. width: bits; one of a bus of one bit is named as the port itself."""

    name: str
    direction: str
    width: int

    def bits(self):
        """Nets of its bits, lowest first."""
        return [self.name] if self.width == 1 else [f"{self.name}[{i}]" for i in range(self.width)]


@dataclass(frozen=True)
class Instance:
    """pins: dict pin -> net, supplies left out; of a block's buses bit by bit, name[bit]."""

    name: str
    cell: str
    pins: dict


@dataclass(frozen=True)
class Netlist:
    """name: module. ports: tuple of Port. instances: tuple of Instance. A net is what has its name."""

    name: str
    ports: tuple
    instances: tuple

    @classmethod
    def read(cls, path):
        data = json.loads(Path(path).read_text())
        return cls(
            data["name"], tuple(Port(**p) for p in data["ports"]), tuple(Instance(**i) for i in data["instances"])
        )

    def write(self, path):
        Path(path).write_text(json.dumps(asdict(self), indent=0) + "\n")

    @classmethod
    def from_yosys(cls, path, top, buffer, macros=(), known=frozenset()):
        """The module ``top`` of Yosys's JSON, every cell one of the library and every constant a cell's output.

        buffer: (cell, input, output) put in where two ports are one signal. A flip-flop is named after its register,
        a block, whose cell is one of ``macros``, as in the Verilog, any other cell u<number>. known: names of
        registers, which count before others that a flip-flop's output has, too.
        """
        modules = json.loads(Path(path).read_text())["modules"]
        module = modules[top]
        names, ports, extra = {}, [], []
        for name, port in module["ports"].items():
            made = Port(name, port["direction"], len(port["bits"]))
            ports.append(made)
            for net, bit in zip(made.bits(), port["bits"], strict=True):
                if bit in names:
                    extra.append(Instance(f"port{len(extra)}", buffer[0], {buffer[1]: names[bit], buffer[2]: net}))
                else:
                    names[bit] = net
        registers = {}
        for name, wire in sorted(module["netnames"].items(), key=lambda item: (item[1]["hide_name"], item[0])):
            for bit, full in named_bits(name, wire):
                if full in known and registers.get(bit) not in known:
                    registers[bit] = full
                registers.setdefault(bit, full)
        instances = []
        for number, (called, cell) in enumerate(module["cells"].items()):
            pins = {}
            for pin, bits in cell["connections"].items():
                for net, bit in zip(Port(pin, "", len(bits)).bits(), bits, strict=True):
                    if not isinstance(bit, int):
                        raise StepError(f"netlist of {top}: pin {net} of a {cell['type']} is constant {bit}")
                    pins[net] = names.setdefault(bit, f"n{bit}")
            for pin, port in modules[cell["type"]]["ports"].items() if cell["type"] in macros else ():
                for net in Port(pin, "", len(port["bits"])).bits():
                    pins.setdefault(net, f"{called}.{net}")  # an output that nothing takes
            name = (
                registers[cell["connections"]["q"][0]] + REGISTER
                if is_register(cell["type"])
                else called
                if cell["type"] in macros
                else f"u{number}"
            )
            instances.append(Instance(name, cell["type"], pins))
        return cls(top, tuple(ports), (*instances, *extra))

    def apart(self, macros, buffer):
        """The Netlist with a buffer (cell, input, output) between its inputs and blocks, whose cells are ``macros``:
        else a wire from outside would end in a block alone, with nothing here that keeps it from being an antenna.
        Clocks stay."""
        inputs = {net for port in self.ports if port.direction == "input" for net in port.bits()}
        inputs -= {i.pins["clk"] for i in self.instances if is_register(i.cell)}
        shared = sorted({net for i in self.instances if i.cell in macros for net in i.pins.values()} & inputs)
        behind = {net: f"{net}_inside" for net in shared}
        instances = [
            Instance(i.name, i.cell, {pin: behind.get(net, net) for pin, net in i.pins.items()})
            if i.cell in macros
            else i
            for i in self.instances
        ]
        instances += [
            Instance(f"inside{k}", buffer[0], {buffer[1]: net, buffer[2]: behind[net]}) for k, net in enumerate(shared)
        ]
        return Netlist(self.name, self.ports, tuple(instances))

    def verilog(self):
        """Structural Verilog with the ports of the RTL."""
        declared = {net for port in self.ports for net in port.bits()}
        nets = sorted({net for i in self.instances for net in i.pins.values()} - declared)
        lines = [f"module {self.name} ({', '.join(port.name for port in self.ports)});"]
        for port in self.ports:
            bus = f"[{port.width - 1}:0] " if port.width > 1 else ""
            lines.append(f"  {port.direction} {bus}{port.name};")
        lines += [f"  wire {_escaped(net)};" for net in nets]
        for i in filter(lambda instance: instance.pins, self.instances):  # what only fills gaps has none
            pins = {pin: net if net in declared else _escaped(net) for pin, net in i.pins.items()}
            joined = ", ".join(f".{pin}({net})" for pin, net in sorted(_buses(pins).items()))
            lines.append(f"  {i.cell} {_escaped(i.name)} ({joined});")
        return "\n".join([*lines, "endmodule", ""])

    def spice(self, cells):
        """The subcircuit, its supplies ports too, followed by ``cells``, the text of the cells' subcircuits."""
        orders = {m[1]: m[2].split() for m in re.finditer(r"(?im)^\.subckt (\S+) (.*)$", cells)}
        ports = [net for port in self.ports for net in port.bits()] + list(SUPPLIES)
        lines = [f".subckt {self.name} " + " ".join(ports)]
        for number, i in enumerate(self.instances):
            pins = i.pins | {name: name for name in SUPPLIES}
            lines.append(f"X{number} " + " ".join(_plain(pins[pin]) for pin in orders[i.cell]) + f" {i.cell}")
        return "\n".join([*lines, ".ends", cells])

    def blif(self, model, net_names, blocks=None):
        """For Coriolis: model ``model``, nets by ``net_names`` (dict net -> name), instances in their order.

        blocks: dict instance -> (cell, dict pin -> name), where both have other names than here.
        """
        lines = [f".model {model}"]
        for word, direction in ((".inputs", "input"), (".outputs", "output")):
            nets = [net_names[net] for port in self.ports if port.direction == direction for net in port.bits()]
            lines.append(f"{word} {' '.join(nets)}")
        for i in self.instances:
            cell, pins = (blocks or {}).get(i.name, (i.cell, {}))
            lines.append(
                f".gate {cell} " + " ".join(f"{pins.get(pin, pin)}={net_names[net]}" for pin, net in i.pins.items())
            )
        return "\n".join([*lines, ".end", ""])


def _buses(pins):
    """dict port -> Verilog of what is on it, from that of its bits, which are named port[bit]."""
    made, buses = {}, {}
    for pin, net in pins.items():
        name, bit = re.fullmatch(r"(.*?)(?:\[(\d+)\])?", pin).groups()
        if bit is None:
            made[name] = net
        else:
            buses.setdefault(name, {})[int(bit)] = net
    return made | {
        name: f"{{{', '.join(bits[k] for k in sorted(bits, reverse=True))}}}" for name, bits in buses.items()
    }


def is_register(cell):
    """Whether the library's cell of that name holds a bit."""
    return cell.startswith("dff")


def _escaped(name):
    return name if re.fullmatch(r"[A-Za-z_]\w*", name) else f"\\{name} "


def _plain(name):
    """For SPICE, where a name holds no blank."""
    return re.sub(r"\s", "_", name)
