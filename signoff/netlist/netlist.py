"""A flat netlist of library cells: from Yosys or from a routed design, as Verilog, SPICE or JSON."""

import json
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from talbot.base.steps import StepError

SUPPLIES = ("vdd", "vss")
# Of the cells of PDKMaster, and of SkyWater
OUTPUT_PINS = "q", "nq", "zero", "one", "sum", "carry", "X", "Y", "Q", "Q_N", "HI", "LO", "SUM", "COUT"
DIODE = "diode_w1"  # of PDKMaster's cells
REGISTER = "_reg"  # after a register's name: its flip-flop


def supplies(plan: Mapping[str, Any]) -> tuple[str, str]:
    """Names of supply and ground in a design's layout, by its floorplan."""
    high, low = plan.get("supplies", SUPPLIES)
    return high, low


def register_names(path: Path, top: str) -> set[str]:
    """Return every name of every register of the module ``top`` of Yosys's JSON, one of simple flip-flops."""
    module = json.loads(path.read_text(encoding="utf-8"))["modules"][top]
    bits = {cell["connections"]["Q"][0] for cell in module["cells"].values() if "DFF" in cell["type"]}
    return {full for name, net in module["netnames"].items() for bit, full in named_bits(name, net) if bit in bits}


def named_bits(name: str, net: Mapping[str, Any]) -> Iterator[tuple[int | str, str]]:
    """Yield (bit, its full name) of a net of Yosys's JSON."""
    for index, bit in enumerate(net["bits"]):
        yield bit, name if len(net["bits"]) == 1 else f"{name}[{index + net.get('offset', 0)}]"


@dataclass(frozen=True)
class Port:
    """A port of ``width`` bits, 'input' or 'output'; a bus of one bit is named as the port itself."""

    name: str
    direction: str
    width: int

    def bits(self) -> list[str]:
        """Nets of its bits, lowest first."""
        return [self.name] if self.width == 1 else [f"{self.name}[{i}]" for i in range(self.width)]


@dataclass(frozen=True)
class Instance:
    """A cell and its nets by pin, without supplies."""

    name: str
    cell: str
    pins: dict[str, str]

    def net(self, pin: str) -> str:
        """The net of a pin whose name a library writes in small or in capital letters."""
        return self.pins[pin] if pin in self.pins else self.pins[pin.upper()]

    def with_nets(self, names: Mapping[str, str]) -> "Instance":
        """The same with other nets, by name, where ``names`` has them."""
        return replace(self, pins={pin: names.get(net, net) for pin, net in self.pins.items()})


class Buffer(NamedTuple):
    """A buffer of the library: the cell, its input and its output."""

    cell: str
    input: str
    output: str

    def instance(self, name: str, source: str, target: str) -> Instance:
        """The instance from the net ``source`` to the net ``target``."""
        return Instance(name, self.cell, {self.input: source, self.output: target})


@dataclass(frozen=True)
class Netlist:
    """The module ``name``. A net is its name."""

    name: str
    ports: tuple[Port, ...]
    instances: tuple[Instance, ...]

    @classmethod
    def read(cls, path: Path) -> "Netlist":
        """Read a file that `write` wrote."""
        data = json.loads(path.read_text(encoding="utf-8"))
        ports, instances = (Port(**p) for p in data["ports"]), (Instance(**i) for i in data["instances"])
        return cls(data["name"], tuple(ports), tuple(instances))

    def write(self, path: Path) -> None:
        """Write as JSON."""
        path.write_text(json.dumps(asdict(self), indent=0) + "\n", encoding="utf-8")

    @classmethod
    def from_yosys(cls, path: Path, top: str, buffer: Buffer, registers: Collection[str] = ()) -> "Netlist":
        """Read the module ``top`` of Yosys's JSON, every cell one of the library and every constant a cell's output.

        buffer: inserted where two ports are one signal. A flip-flop is named after its register, any other cell
        u<number>. registers: names that come before others of a flip-flop's output. Raises StepError for a constant
        pin.
        """
        module = json.loads(path.read_text(encoding="utf-8"))["modules"][top]
        names, ports, extra = {}, [], []
        for name, port in module["ports"].items():
            made = Port(name, port["direction"], len(port["bits"]))
            ports.append(made)
            for net, bit in zip(made.bits(), port["bits"], strict=True):
                if bit in names:
                    extra.append(buffer.instance(f"port{len(extra)}", names[bit], net))
                else:
                    names[bit] = net
        register_of = {}
        for name, net in sorted(module["netnames"].items(), key=lambda item: (item[1]["hide_name"], item[0])):
            for bit, full in named_bits(name, net):
                if full in registers and register_of.get(bit) not in registers:
                    register_of[bit] = full
                register_of.setdefault(bit, full)
        instances = []
        for number, cell in enumerate(module["cells"].values()):
            pins = {}
            for pin, bits in cell["connections"].items():
                for net, bit in zip(Port(pin, "", len(bits)).bits(), bits, strict=True):
                    if not isinstance(bit, int):
                        raise StepError(f"netlist of {top}: pin {net} of a {cell['type']} is constant {bit}")
                    pins[net] = names.setdefault(bit, f"n{bit}")
            name = f"u{number}"
            if is_register(cell["type"]):
                name = register_of[cell["connections"].get("q", cell["connections"].get("Q"))[0]] + REGISTER
            instances.append(Instance(name, cell["type"], pins))
        return cls(top, tuple(ports), (*instances, *extra))

    def verilog(self) -> str:
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

    def connected_ports(self) -> list[str]:
        """Nets of the ports that some cell is on."""
        used = {net for instance in self.instances for net in instance.pins.values()}
        return [net for port in self.ports for net in port.bits() if net in used]

    def spice(self, cells: str, supplies: Sequence[str] = SUPPLIES) -> str:
        """The subcircuit, its ``supplies`` ports too, followed by ``cells``, the text of the cells' subcircuits.

        Ports that no cell is on are left out, as KLayout leaves out nets without a device.
        """
        orders = {m[1]: m[2].split() for m in re.finditer(r"(?im)^\.subckt (\S+) (.*)$", cells)}
        ports = [*self.connected_ports(), *supplies]
        lines = [f".subckt {self.name} " + " ".join(ports)]
        for number, i in enumerate(self.instances):
            pins = i.pins | dict(zip(SUPPLIES, supplies, strict=True))
            lines.append(f"X{number} " + " ".join(_plain(pins[pin]) for pin in orders[i.cell]) + f" {i.cell}")
        return "\n".join([*lines, ".ends", cells])


def _buses(pins: Mapping[str, str]) -> dict[str, str]:
    """Verilog of the nets by port, from those of its bits, which are named port[bit]."""
    made, buses = {}, {}
    for pin, net in pins.items():
        name, bracket, bit = pin.rstrip("]").rpartition("[")
        if bracket:
            buses.setdefault(name, {})[int(bit)] = net
        else:
            made[pin] = net
    return made | {bus: f"{{{', '.join(bits[k] for k in sorted(bits, reverse=True))}}}" for bus, bits in buses.items()}


def diode(net: str, number: int) -> Instance:
    """Return a diode against antennas on ``net``."""
    return Instance(f"antenna_{number}", DIODE, {"i": net})


def with_diodes(netlist: Netlist, nets: Sequence[str], fill: Mapping[str, int]) -> Netlist:
    """Add diodes on ``nets``, and so many more (or fewer) cells of each kind of ``fill``."""
    kept, fewer = [], {cell: -count for cell, count in fill.items() if count < 0}
    for instance in netlist.instances:
        if not instance.pins and fewer.get(instance.cell, 0):
            fewer[instance.cell] -= 1
        else:
            kept.append(instance)
    more = [Instance(f"fill_{cell}_{k}", cell, {}) for cell, count in fill.items() for k in range(count)]
    return replace(netlist, instances=(*kept, *more, *(diode(net, k) for k, net in enumerate(nets))))


def is_register(cell: str) -> bool:
    """Whether the library's cell of that name is a flip-flop: dff_x1 of PDKMaster, <library>__dfxtp_1 of SkyWater."""
    return cell.rpartition("__")[2].startswith("df")


def _escaped(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z_]\w*", name) else f"\\{name} "


def _plain(name: str) -> str:
    """For SPICE, where a name has no blank."""
    return re.sub(r"\s", "_", name)
