"""Layout against netlist with a foundry's cells: their own transistor netlists, a deck of the process in KLayout."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from talbot.base.steps import Files, Step, StepError
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.openroad.netlists import routed_netlist
from talbot.platforms.openroad import openroad_platform
from talbot.signoff.geometry.decks import run_deck
from talbot.signoff.netlist.netlist import Instance, Netlist

DEVICE = re.compile(r"^[XR](\S+) (.*) (\S+) w=(\S+) l=(\S+)$", re.I | re.M)
SUBCIRCUIT = re.compile(r"^\.subckt (\S+) (.*?)$(.*?)^\.ends", re.I | re.M | re.S)


class Lvs(Step[PdkParameters]):
    """Every instance with transistors, its supplies and wells as in the routed database; every port by its name."""

    name = "lvs"
    inputs = {"gds": "fill.gds", "powered": "powered", "cells": "cells.spice"}
    outputs = {"report": "lvs.lvsdb", "deck": "ports.lvs", "spice": "netlist.spi"}
    metrics = {"lvs_match": "", "transistors": ""}
    tools = ("klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        netlist = routed_netlist(inputs["powered"], top_of(inputs["powered"]))
        cells = subcircuits(inputs["cells"].read_text(encoding="utf-8"))
        outputs["spice"].write_text(spice(netlist, cells), encoding="utf-8")
        deck = openroad_platform(self.parameters.pdk).lvs.read_text(encoding="utf-8")
        ports = (net for port in netlist.ports for net in port.bits())
        same = "".join(f'same_nets!("{netlist.name}", "{net}", "{net}")\n' for net in ports)
        outputs["deck"].write_text(deck.replace("PORTS\n", same), encoding="utf-8")
        paths = {"gds": inputs["gds"].resolve(), "spice": outputs["spice"], "report": outputs["report"]}
        _, output = run_deck(outputs["deck"], outputs["report"], paths)
        if ("LVS OK" in output) == ("LVS Failed" in output):
            raise StepError(f"lvs: KLayout gave no verdict: {output.strip().splitlines()[-1:]}")
        count = sum(len(cells[i.cell][1]) for i in netlist.instances if i.cell in cells)
        return {"lvs_match": "LVS OK" in output, "transistors": count}


def top_of(verilog: Path) -> str:
    """Return the module of a netlist's file."""
    found = re.search(r"(?m)^module (\S+)", verilog.read_text(encoding="utf-8"))
    if not found:
        raise StepError(f"lvs: {verilog}: no module")
    return found[1]


def subcircuits(text: str) -> dict[str, tuple[list[str], list[str]]]:
    """(ports, lines of its devices) by cell of a foundry's SPICE; cells without transistors are left out."""
    found = {}
    for name, ports, body in SUBCIRCUIT.findall(text):
        if devices := [_device(match) for match in DEVICE.finditer(body)]:
            found[name] = ports.split(), devices
    return found


def spice(netlist: Netlist, cells: dict[str, tuple[list[str], list[str]]]) -> str:
    """Return the netlist with supplies, and the subcircuits that it uses."""
    used = [instance for instance in netlist.instances if instance.cell in cells]
    ports = " ".join(net for port in netlist.ports for net in port.bits())
    lines = [f".subckt {netlist.name} {ports}", *(_call(k, i, cells[i.cell][0]) for k, i in enumerate(used)), ".ends"]
    for name in sorted({instance.cell for instance in used}):
        lines += [f".subckt {name} {' '.join(cells[name][0])}", *cells[name][1], ".ends"]
    return "\n".join([*lines, ""])


def _call(number: int, instance: Instance, ports: Sequence[str]) -> str:
    nets = (instance.pins.get(port, f"open{number}_{port}") for port in ports)
    return f"X{number} {' '.join(nets)} {instance.cell}"


def _device(match: re.Match[str]) -> str:
    """Return a transistor, or the resistor without resistance of the constants' cell."""
    name, nets, kind, width, length = match.groups()
    if kind == "short" or "__res_" in kind:
        return f"R{name} {' '.join(nets.split()[:2])} 0 SHORT"
    return f"M{name} {nets} {'NFET' if 'nfet' in kind else 'PFET'} W={_um(width)}U L={_um(length)}U"


def _um(value: str) -> float:
    """Micrometers of a length in SkyWater's SPICE: '0.65', or in its own unit '650000u'."""
    return float(value[:-1]) / 1e6 if value.endswith("u") else float(value)
