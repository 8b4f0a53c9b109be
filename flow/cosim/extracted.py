"""The drawn circuits with their parasitics, for the deck of a co-simulation: flow/analog_layout draws and extracts."""

import re
from collections.abc import Mapping
from functools import cache

from talbot.pixels.circuits.netlist import Circuit

PDK, WIRES = "sky130", "typ"
NAMES = "sar_lane", "amplifier", "bias", "column"


@cache
def circuits() -> Mapping[str, Circuit]:
    """Each of NAMES, with the ports of its schematic. Raises ModuleNotFoundError without the packages of layouts."""
    from talbot.flow.analog.job import amplifier_of, column_of, setup_of
    from talbot.flow.analog_layout.extract import extract
    from talbot.flow.analog_layout.job import cells
    from talbot.platforms.analog import analog_masks
    from talbot.platforms.coriolis import coriolis_platform

    masks, (setup, sizes) = analog_masks(PDK), setup_of(PDK)
    made = cells(masks, sizes, amplifier_of(setup, sizes)[1], 1, column_of(setup)[1])
    wires = coriolis_platform(PDK).wires[WIRES]
    return {name: extract(made[name], masks, wires)[0] for name in NAMES}


def rest_of_nets(body: list[str], drawn: Mapping[str, Circuit]) -> list[str]:
    """Lines that begin every node of a net of ``drawn`` circuits, net__1, net__2, .., where ``body`` begins the net."""
    calls = (line.split() for line in body if line.startswith("X"))
    called = {words[0].lower(): words[-1] for words in calls if words[-1] in drawn}
    nodes = {name: {n for r in one.resistors for n in (r.a, r.b)} for name, one in drawn.items()}
    begun = re.findall(r"v\((\w+)\.([\w.]+)\)=(\S+)", "\n".join(line for line in body if line.startswith(".ic ")))
    return [
        f".ic v({instance}.{node})={volts}"
        for instance, net, volts in begun
        for node in sorted(nodes.get(called.get(instance, ""), ()))
        if node.startswith(f"{net}__")
    ]
