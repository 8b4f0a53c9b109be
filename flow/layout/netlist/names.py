"""Short names of nets for tools that do not take every name that Verilog allows."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .netlist import Netlist

CLOCK = "clk"  # name of the clock net in the netlist given to Coriolis


def plain_names(netlist: "Netlist", clock: str) -> dict[str, str]:
    """Map each net to a name of letters and digits only; the net ``clock`` to CLOCK."""
    nets = dict.fromkeys(net for port in netlist.ports for net in port.bits())
    nets.update(dict.fromkeys(net for instance in netlist.instances for net in instance.pins.values()))
    return {net: CLOCK if net == clock else f"w{number}" for number, net in enumerate(nets)}
