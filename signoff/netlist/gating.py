"""Clock gates: registers that share an enable are clocked only while it is high.

Debian's Yosys (0.23) has no pass `clockgate`. Here a flip-flop with an enable becomes a plain one behind a gate of its
own, then gates with the same inputs are merged. Synchronous resets go to the data and the enable; groups of fewer than
LEAST flip-flops keep their multiplexers.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from talbot.signoff.netlist.buffering import clusters, estimated
from talbot.signoff.netlist.netlist import Buffer, Instance, Netlist, is_register

LEAST = 2  # flip-flops behind a gate: it takes as much energy as one of them
GATES = "gates.ys"  # file of the commands
SCRIPT = """dfflegalize -mince {least} -cell $_DFF_P_ x -cell $_DFFE_PP_ x -cell $_SDFF_PP?_ x -cell $_SDFFCE_PP?P_ x
dffunmap -srst-only
opt_merge
techmap -map {map}
read_verilog -lib {gate}
opt_merge -share_all
"""
MAP = r"""module \$_DFFE_PP_ (input D, C, E, output Q);
  wire gated;
  {cell} gate (.{enable}(E), .{clock}(C), .{output}(gated));
  \$_DFF_P_ register (.D(D), .C(gated), .Q(Q));
endmodule
"""
GATE = """module {cell} (input {enable}, {clock}, output {output});
endmodule
"""


class ClockGate(NamedTuple):
    """A clock gate of the library, a latch that is open while the clock is low before an AND: the cell and its pins."""

    cell: str
    enable: str
    clock: str
    output: str

    def files(self, folder: Path = Path()) -> dict[Path, str]:
        """Texts by path. Yosys runs `GATES` on a design of simple gates."""
        read = {"map": folder / "gate_map.v", "gate": folder / "gate.v"}
        script = SCRIPT.format(least=LEAST, **read)
        names = self._asdict()
        return {folder / GATES: script, read["map"]: MAP.format(**names), read["gate"]: GATE.format(**names)}


class ClockCells(NamedTuple):
    """What drives registers: the gate, and the buffer that is as slow, of those without an enable."""

    gate: ClockGate
    buffer: Buffer


def drive_registers(
    netlist: Netlist, sides: Mapping[str, Sequence[str]], clock: str, sizes: Sequence[ClockCells], most: int
) -> Netlist:
    """Put every register behind a gate or a buffer of its own level, ``most`` registers at most behind each.

    So the clock reaches all of them through as many cells, of which the tree drives none but these. Registers that will
    be near each other share one. sides: see `buffer_fan_out`. sizes: the weakest first, for equal shares of ``most``;
    the netlist has the first's gates.
    """
    gate = sizes[0].gate
    instances = [replace(i, pins=dict(i.pins)) for i in netlist.instances]
    sinks: dict[str, list[int]] = {}
    for number, instance in enumerate(instances):
        if is_register(instance.cell):
            sinks.setdefault(instance.pins[gate.clock], []).append(number)
    gates = {i.pins[gate.output]: i for i in instances if i.cell == gate.cell}
    places = estimated(instances, sides, {clock, *sinks})
    made: list[Instance] = []
    for net, registers in sinks.items():
        for k, group in enumerate(clusters(places[registers], most)):
            cells, branch = sizes[(len(group) - 1) * len(sizes) // most], f"{net}_branch{k}"
            if net == clock:
                made.append(cells.buffer.instance(f"{branch}_buffer", net, branch))
            else:
                pins = {**gates[net].pins, gate.output: branch}
                made.append(Instance(f"{gates[net].name}_{k}", cells.gate.cell, pins))
            for number in (registers[k] for k in group):
                instances[number].pins[gate.clock] = branch
    kept = (i for i in instances if i.cell != gate.cell)
    return replace(netlist, instances=(*kept, *made))
