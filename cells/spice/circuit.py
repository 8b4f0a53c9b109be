"""A netlist as ngspice's subcircuit, every transistor with its diffusion and stress."""

from types import ModuleType

from talbot.cells.corner import Corner
from talbot.cells.netlist.spice import Netlist


def circuit(netlist: Netlist, process: ModuleType, models: str, corner: Corner, leakage: bool = False) -> list[str]:
    """The lines of a deck: models, the subcircuit, and one instance of it whose nodes have the ports' names.

    process: a module like platforms.sky130.models. models: its set of models; with ``leakage`` those for leakage.
    """
    used = {(t.model, t.size["w"], t.size["l"]) for t in netlist.transistors}
    lines = [*process.cards(models, corner.process, used, leakage), f".subckt {netlist.name} {' '.join(netlist.ports)}"]
    for t in netlist.transistors:
        size = " ".join(f"{key}={value:.6g}" for key, value in process.drawn(t.size).items())
        lines.append(f"X{t.name} {t.drain} {t.gate} {t.source} {t.bulk} {t.model} {size}")
    lines += [f"C{c.name} {c.a} {c.b} {c.value:.6g}" for c in netlist.capacitors]
    lines += [f"R{r.name} {r.a} {r.b} {r.value:.6g}" for r in netlist.resistors]
    return [*lines, ".ends", f"Xcell {' '.join(netlist.ports)} {netlist.name}"]
