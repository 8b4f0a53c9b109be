"""Netlists: from Yosys with registers named as in the Verilog; the final one with the names of SDF and SPEF."""

import json
import tempfile
from pathlib import Path
from typing import Any

from talbot.base.steps import StepError
from talbot.base.tools import plain, run
from talbot.platforms.openroad import OpenRoadPlatform
from talbot.signoff.netlist.netlist import Buffer, Instance, Netlist, Port, named_bits, register_names


def write_synthesized(folder: Path, top: str, tech: OpenRoadPlatform) -> None:
    """Write netlist.v in ``folder`` from Yosys's netlist.json and registers.json there."""
    names = register_names(folder / "registers.json", top)
    netlist = Netlist.from_yosys(folder / "netlist.json", top, Buffer(*tech.buffer), registers=names)
    (folder / "netlist.v").write_text(netlist.verilog(), encoding="utf-8")


def routed_netlist(verilog: Path, top: str) -> Netlist:
    """Read the module ``top`` of cells in the file ``verilog``. Raises StepError for a constant pin or joined ports."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        path = Path(folder) / "netlist.json"
        run(["yosys", "-q", "-p", f"read_verilog {plain(verilog)}; write_json {path}"])
        module = json.loads(path.read_text(encoding="utf-8"))["modules"][top]
    names: dict[Any, str] = {}
    ports = tuple(Port(name, port["direction"], len(port["bits"])) for name, port in module["ports"].items())
    for port in ports:
        for net, bit in zip(port.bits(), module["ports"][port.name]["bits"], strict=True):
            if names.setdefault(bit, net) != net:
                raise StepError(f"netlist of {top}: ports {names[bit]} and {net} are one net")
    for name, net in sorted(module["netnames"].items(), key=lambda item: item[1]["hide_name"]):
        for bit, full in named_bits(name, net):
            names.setdefault(bit, full)
    instances = []
    for name, cell in module["cells"].items():
        pins = {pin: bits[0] for pin, bits in cell["connections"].items() if bits}
        if wrong := next((pin for pin, bit in pins.items() if not isinstance(bit, int)), None):
            raise StepError(f"netlist of {top}: pin {wrong} of {name} is constant {pins[wrong]}")
        instances.append(Instance(name, cell["type"], {pin: names[bit] for pin, bit in pins.items()}))
    return Netlist(top, ports, tuple(instances))
