"""The pins of a block shared among its sides."""

import math
from collections.abc import Iterable

from talbot.signoff.netlist.netlist import Port

SIDES = ("west", "east")  # the router gives up on some pins on the other two


def pins(ports: Iterable[Port]) -> dict[str, list[str]]:
    """Nets of the pins by side, in the order of the ports, buses together."""
    nets = [net for port in sorted(ports, key=lambda port: port.direction) for net in port.bits()]
    share = math.ceil(len(nets) / len(SIDES))
    return {side: nets[k * share : (k + 1) * share] for k, side in enumerate(SIDES)}
