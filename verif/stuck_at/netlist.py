"""The chip as simple gates and flip-flops by Yosys, in the order in which they are evaluated."""

import json
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.tools import run

# Mapped module by module, so that a gate's name begins with its block
SCRIPT = """read_verilog -sv {path}; hierarchy -check -top {top}; proc; opt; fsm_map; memory_map; opt; techmap; opt;
dfflegalize -cell $_DFF_P_ x; abc -g AND,NAND,OR,NOR,XOR,XNOR,MUX; opt_clean; flatten -noscopeinfo; opt_clean;
setundef -undriven -zero; opt_clean; write_json {out}"""
OPERATORS = ("AND", "NAND", "OR", "NOR", "XOR", "XNOR", "MUX", "NOT", "BUF", "FF")
AND, NAND, OR, NOR, XOR, XNOR, MUX, NOT, BUF, FF = range(len(OPERATORS))
PINS = {MUX: "ABS", NOT: "A", BUF: "A", FF: "D"}
ZERO, ONE = 0, 1  # nets of the constants


@dataclass(frozen=True)
class Gates:
    """Gates and flip-flops; gate i drives net ``out[i]``.

    names: of the cells. kinds: index into OPERATORS. ins: int32 (gates, 3), nets, ZERO where a kind has fewer.
    gates: the number of gates; the flip-flops follow them. nets: their number. inputs, outputs: port -> nets.
    """

    names: list[str]
    kinds: npt.NDArray[np.int32]
    ins: npt.NDArray[np.int32]
    out: npt.NDArray[np.int32]
    gates: int
    nets: int
    inputs: dict[str, list[int]]
    outputs: dict[str, list[int]]

    def block(self, gate: int) -> str:
        """Return the instance in the top that has a gate, or 'top'."""
        match = re.match(r"\$flatten\\(\w+)\.", self.names[gate])
        return match[1] if match else "top"


def synthesize(verilog: str, top: str) -> Gates:
    """Map module ``top`` of ``verilog`` to gates. Raises ToolError."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        path, out = Path(folder) / "design.v", Path(folder) / "gates.json"
        path.write_text(verilog, encoding="utf-8")
        run(["yosys", "-q", "-p", SCRIPT.format(path=path, top=top, out=out)])
        return ordered(json.loads(out.read_text(encoding="utf-8"))["modules"][top])


def ordered(module: dict[str, Any]) -> Gates:
    """Return the module of Yosys's JSON with its gates in the order of evaluation."""
    number: dict[int | str, int] = {"0": ZERO, "1": ONE, "x": ZERO}

    def net(bit: int | str) -> int:
        return number.setdefault(bit, len(number) - 1)

    ports = {name: [net(bit) for bit in port["bits"]] for name, port in module["ports"].items()}
    directions = {name: port["direction"] for name, port in module["ports"].items()}
    cells = []
    for name, cell in module["cells"].items():
        kind = FF if cell["type"] == "$_DFF_P_" else OPERATORS.index(cell["type"].strip("$_"))
        pins = cell["connections"]
        ins = [net(pins[pin][0]) for pin in PINS.get(kind, "AB")]
        cells.append((name, kind, ins, net(pins["Q" if kind == FF else "Y"][0])))
    driven = {ZERO, ONE, *(n for name, nets in ports.items() if directions[name] == "input" for n in nets)}
    driven |= {out for _, kind, _, out in cells if kind == FF}
    readers: dict[int, list[int]] = {}
    lacking = [len(set(ins) - driven) if kind != FF else 0 for _, kind, ins, _ in cells]
    for i, (_, kind, ins, _) in enumerate(cells):
        for n in set(ins) - driven if kind != FF else ():
            readers.setdefault(n, []).append(i)
    order = [i for i, (_, kind, _, _) in enumerate(cells) if kind != FF and not lacking[i]]
    for i in order:
        for reader in readers.get(cells[i][3], ()):
            lacking[reader] -= 1
            if not lacking[reader]:
                order.append(reader)
    gates = len(order)
    order += [i for i, (_, kind, _, _) in enumerate(cells) if kind == FF]
    if len(order) != len(cells):
        raise ValueError("netlist = a loop of gates: must have none")
    return Gates(
        [cells[i][0] for i in order],
        np.array([cells[i][1] for i in order], np.int32),
        np.array([(*cells[i][2], ZERO, ZERO)[:3] for i in order], np.int32).reshape(-1, 3),
        np.array([cells[i][3] for i in order], np.int32),
        gates,
        len(number),
        {name: nets for name, nets in ports.items() if directions[name] == "input"},
        {name: nets for name, nets in ports.items() if directions[name] == "output"},
    )
