"""Short names of nets for tools that do not take every name that Verilog allows."""

from talbot.signoff.netlist.netlist import Netlist


def plain_names(netlist: Netlist) -> dict[str, str]:
    """Map each net to a name of letters and digits only."""
    nets = dict.fromkeys(net for port in netlist.ports for net in port.bits())
    nets.update(dict.fromkeys(net for instance in netlist.instances for net in instance.pins.values()))
    return {net: f"w{number}" for number, net in enumerate(nets)}
