"""The drawn circuits with their parasitics, for the deck of a co-simulation: pixels/post_layout draws and extracts."""

import re
from collections.abc import Mapping
from functools import cache

from talbot.models.parameters import STANDARD
from talbot.pixels.circuits.netlist import Circuit

PDK, WIRES = "sky130", "typ"
NAMES = "sar_lane", "amplifier", "bias", "column"


@cache
def circuits() -> Mapping[str, Circuit]:
    """Each of NAMES, with the ports of its schematic. Raises ModuleNotFoundError without the packages of layouts."""
    from talbot.pixels.datasheet.job import amplifier_of, column_of, setup_of
    from talbot.pixels.post_layout.extract import extract
    from talbot.pixels.post_layout.job import cells
    from talbot.platforms.analog import analog_masks
    from talbot.platforms.layout import layout_platform

    masks, (setup, sizes) = analog_masks(PDK), setup_of(PDK)
    made = cells(masks, sizes, amplifier_of(setup, sizes)[1], 1, column_of(setup)[1], STANDARD.array)
    wires = layout_platform(PDK).wires[WIRES]
    return {name: extract(made[name], masks, wires)[0] for name in NAMES}


def flat(net: str) -> str:
    """Return a net's name where its instance has no circuits in it: xcolumn0.on1.m of xcolumn0.xon1.m."""
    return re.sub(r"(?<=\.)x(?=\w+\.)", "", net)


def as_drawn(body: list[str], drawn: Mapping[str, Circuit]) -> list[str]:
    """``body``, in which all nodes of a net of a ``drawn`` circuit, net, net__1, .., begin where the net does."""
    calls = (line.split() for line in body if line.startswith("X"))
    called = {words[0].lower(): words[-1] for words in calls if words[-1] in drawn}
    nodes = {name: {n for r in one.resistors for n in (r.a, r.b)} for name, one in drawn.items()}

    def begun(match: re.Match[str]) -> str:
        instance, _, net = flat(match[1]).partition(".")
        if instance not in called:
            return match[0]
        rest = sorted(node for node in nodes[called[instance]] if node.startswith(f"{net}__"))
        return " ".join(f"v({instance}.{node})={match[2]}" for node in (net, *rest))

    begins = re.compile(r"v\((\S+)\)=(\S+)")
    return [begins.sub(begun, line) if line.startswith(".ic ") else line for line in body]
