"""Setup slack of a netlist that is not routed, its wires estimated."""

import tempfile
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

from talbot.flow.layout.timing.opensta import TIMED, opensta, worst_slack
from talbot.signoff.netlist.netlist import OUTPUT_PINS, Netlist
from talbot.signoff.parasitics.spef import spef

# Of a net that is not placed: fF a driven pin, as many at most; what drives more gets a buffer once it is placed
SINK_FF, MOST = 3.0, 6
OHM = 30.0  # of such a net
UNLOADED = "set_load 0 [all_outputs]"  # a weak driver of a port gets a buffer, too
SCRIPT = f'{TIMED}{{more}}\nputs "WORST setup [worst_slack -max]"'


def unplaced(netlist: Netlist, clock: str) -> dict[str, tuple[float, float]]:
    """(fF, ohm) by net from its fan-out alone; ``clock`` has none, since its tree is not there."""
    sinks = Counter(net for i in netlist.instances for pin, net in i.pins.items() if pin not in OUTPUT_PINS)
    return {net: (SINK_FF * min(count, MOST), OHM) for net, count in sinks.items() if net != clock}


def setup_slack(
    netlist: Netlist, nets: Mapping[str, tuple[float, float]], liberty: Path, sdc: Path, more: str = ""
) -> float:
    """Worst setup slack, ns. nets: (fF, ohm) by net. more: commands after the SDC. Raises StepError without a slack."""
    return worst_slack(_report(netlist, nets, liberty, sdc, more), "setup")


def _report(netlist: Netlist, nets: Mapping[str, tuple[float, float]], liberty: Path, sdc: Path, more: str) -> str:
    with tempfile.TemporaryDirectory(prefix="talbot-") as name:
        files = {kind: Path(name) / kind for kind in ("verilog", "spef")}
        files["verilog"].write_text(netlist.verilog(), encoding="utf-8")
        files["spef"].write_text(spef(netlist, nets), encoding="utf-8")
        script = SCRIPT.format(liberty=liberty, top=netlist.name, sdc=sdc, more=more, **files)
        return opensta(Path(name) / "sta.log", script)
