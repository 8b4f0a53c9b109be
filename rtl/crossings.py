"""Clock-domain crossings: an asynchronous pin passes two flip-flops before anything else reads it.

Yosys reads the design; bit by bit, the pin must lead without logic to one flip-flop, read only by a second one.
"""

import json
import tempfile
from pathlib import Path
from typing import NamedTuple

from talbot.base.tools import plain, run
from talbot.models.parameters import ASYNCHRONOUS

# Gates by a raw pin, as documented in asp_chip/README.md: the pin -> the net that they drive
GATES = {"csn": "miso_oe", "reset": "resets.chip"}
SCRIPT = "read_verilog -sv {path}; hierarchy -check -top {top}; {prepare}; simplemap; opt_clean; write_json {out}"
FLIP_FLOP = "$_DFF_P_"


class Reader(NamedTuple):
    """An input of a cell. out: the bits that the cell drives."""

    cell: str
    kind: str
    port: str
    out: tuple[int, ...]


class Netlist:
    """The flat netlist of a module: readers and names of each bit."""

    def __init__(self, path: Path, top: str, prepare: str) -> None:
        """Read the module ``top`` of the Verilog file ``path``; prepare: commands of Yosys. Raises ToolError."""
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            out = Path(folder) / "netlist.json"
            run(["yosys", "-q", "-p", SCRIPT.format(path=plain(path), top=top, prepare=prepare, out=out)])
            module = json.loads(out.read_text(encoding="utf-8"))["modules"][top]
        self.readers: dict[int, list[Reader]] = {}
        self.nets: dict[str, list[int]] = {name: net["bits"] for name, net in module["netnames"].items()}
        public = sorted(self.nets, key=lambda name: (not module["netnames"][name]["hide_name"], -len(name)))
        self.names = {bit: name for name in public for bit in self.nets[name]}  # a public one, the shortest
        for name, cell in module["cells"].items():
            driven = [p for p, direction in cell["port_directions"].items() if direction == "output"]
            out = tuple(bit for port in driven for bit in cell["connections"][port])
            for port, bits in cell["connections"].items():
                for bit in bits if port not in driven else ():
                    self.readers.setdefault(bit, []).append(Reader(name, cell["type"], port, out))
        for name, port in module["ports"].items():
            for bit in port["bits"] if port["direction"] == "output" else ():
                self.readers.setdefault(bit, []).append(Reader(name, "pin", name, ()))

    def synchronized(self, first: Reader) -> bool:
        """Return whether only the data input of a second flip-flop reads the flip-flop ``first``."""
        return [(r.kind, r.port) for bit in first.out for r in self.readers.get(bit, [])] == [(FLIP_FLOP, "D")]

    def raw(self, bit: int, gates: set[int]) -> set[str]:
        """Return the registers and pins that ``bit`` reaches through logic; the search ends at the bits ``gates``."""
        reached, visited, pending = set(), {bit}, [bit]
        while pending:
            for reader in self.readers.get(pending.pop(), []):
                if reader.kind == "pin" or "DFF" in reader.kind or "$mem" in reader.kind:
                    reached.add(reader.cell if reader.kind == "pin" else self.names.get(reader.out[0], reader.cell))
                else:
                    pending += set(reader.out) - visited - gates
                    visited.update(reader.out)
        return reached


def crossings(path: Path, top: str, prepare: str = "proc; flatten -noscopeinfo") -> list[str]:
    """Return what is wrong at the asynchronous pins of module ``top`` in the file ``path``, one line each.

    prepare: commands of Yosys that make a flat netlist. Raises ToolError.
    """
    netlist, problems = Netlist(path, top, prepare), []
    for pin in ASYNCHRONOUS:
        bits = netlist.nets.get(pin, [])
        for bit in bits:
            first = [r for r in netlist.readers.get(bit, []) if r.kind == FLIP_FLOP and r.port == "D"]
            if len(first) != 1 or not netlist.synchronized(first[0]):
                problems.append(f"{pin} = {len(first)} first flip-flops: must have one, which only a second one reads")
            allowed = set(netlist.nets.get(GATES.get(pin, ""), []))
            raw = netlist.raw(bit, allowed) - {netlist.names.get(r.out[0], r.cell) for r in first}
            problems += [f"{pin} = read by {name}: must pass a synchronizer" for name in sorted(raw)]
    return problems
