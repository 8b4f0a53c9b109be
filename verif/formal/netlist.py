"""A flat design as Yosys writes it in JSON: its signals, the conjuncts of its assumptions, cells added to it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from talbot.models.parameters import ParameterError

Bit = int | str  # a net, or the constant '0', '1' or 'x'
Place = tuple[str, str]  # a cell and its port


@dataclass(frozen=True)
class Conjunct:
    """One of the conditions that an assumption requires.

    path: from the assumption down to the operand. holds: the value required of it. source: its place in the text.
    """

    path: tuple[Place, ...]
    holds: bool
    source: str

    @property
    def assumption(self) -> str:
        """The name of the assumption."""
        return self.path[0][0]


class Netlist:
    """The top module of a design; cells may be added."""

    def __init__(self, design: dict[str, Any], top: str, hierarchy: dict[str, Any]) -> None:
        """design: what `write_json` wrote of the flat design, hierarchy: of the same before it was flat."""
        self.design, self.module, self.modules = design, design["modules"][top], hierarchy["modules"]
        self.instances: dict[str, str] = {
            name: cell["type"] for name, cell in self.modules[top]["cells"].items() if cell["type"] in self.modules
        }
        self.cells: dict[str, Any] = self.module["cells"]
        self.nets: dict[str, Any] = self.module["netnames"]
        self.next = 1 + max(bit for net in self.nets.values() for bit in net["bits"] if isinstance(bit, int))
        self.drivers = {
            bit: name
            for name, cell in self.cells.items()
            for port, direction in cell["port_directions"].items()
            if direction == "output"
            for bit in cell["connections"][port]
        }
        self.driven = {*self.drivers, *(b for p in self.ports("input") for b in self.module["ports"][p]["bits"])}

    def ports(self, direction: str) -> list[str]:
        """Return the ports of the top."""
        return [name for name, port in self.module["ports"].items() if port["direction"] == direction]

    def of_type(self, *kinds: str) -> list[str]:
        """Return the names of the cells of some types."""
        return [name for name, cell in self.cells.items() if cell["type"] in kinds]

    def add(self, kind: str, width: int = 1, init: str = "", **ports: list[Bit]) -> list[Bit]:
        """Add a cell and return its new output, ``Q`` of a register, else ``Y``. ports: inputs. init: of a register."""
        out = "Q" if kind == "$ff" else "Y"
        output: list[Bit] = list(range(self.next, self.next + width))
        self.next += width
        name = f"$added${self.next}"
        parameters = {f"{port}_WIDTH": len(bits) for port, bits in ports.items()}
        parameters |= {f"{port}_SIGNED": 0 for port in ports} | {"Y_WIDTH": width}
        if kind == "$ff":
            parameters = {"WIDTH": width}
        self.cells[name] = {
            "type": kind,
            "parameters": {} if kind.startswith("$_") else parameters,
            "attributes": {},
            "port_directions": dict.fromkeys(ports, "input") | {out: "output"},
            "connections": {**ports, out: output},
        }
        if init:
            self.nets[f"{name}_init"] = {"hide_name": 1, "bits": output, "attributes": {"init": init}}
        self.drivers |= dict.fromkeys(output, name)
        return output

    def check(self, kind: str, name: str, condition: Bit) -> None:
        """Add a cell of type ``$assert`` or ``$cover``."""
        self.cells[name] = {
            "type": kind,
            "parameters": {},
            "attributes": {},
            "port_directions": {"A": "input", "EN": "input"},
            "connections": {"A": [condition], "EN": ["1"]},
        }

    def before(self, net: list[Bit]) -> list[Bit]:
        """Return a net that is high when ``net`` was in an earlier cycle."""
        either = self.add("$_OR_", A=net, B=["0"])
        late = self.add("$ff", init="0", D=either)
        self.cells[self.drivers[either[0]]]["connections"]["B"] = late
        return late

    def begin(self, values: Mapping[str, int]) -> None:
        """Let every register begin with any value, except those in ``values``, which begin with the value there."""
        for name, net in self.nets.items():
            net["attributes"].pop("init", None)
            if name in values:
                net["attributes"]["init"] = f"{values[name]:0{len(net['bits'])}b}"
        if unknown := values.keys() - self.nets.keys():
            raise ParameterError(f"free_from = {', '.join(sorted(unknown))}: must be registers of the wrapper")

    def conjuncts(self, assumption: str) -> list[Conjunct]:
        """Return the parts whose removal weakens an assumption, at any depth.

        They are the operands of its conjunctions, and those of the disjunctions in its conditions.
        """
        whole = (assumption, "A")
        parts = [*self._parts((whole,), True), *self._parts(((assumption, "EN"),), False)] or [((whole,), True)]
        return [Conjunct(path, holds, self._source(path)) for path, holds in parts]

    def drop(self, conjunct: Conjunct) -> None:
        """Remove ``conjunct``: the operand gets the value required of it. Cells on its path are copied."""
        new: Bit = "1" if conjunct.holds else "0"
        for name, port in reversed(conjunct.path[1:]):
            cell = self.cells[name]
            (copy,) = self.add(cell["type"])
            width = {f"{port}_WIDTH": 1} if f"{port}_WIDTH" in cell["parameters"] else {}
            self.cells[self.drivers[copy]] = cell | {
                "parameters": cell["parameters"] | width,
                "connections": cell["connections"] | {port: [new], "Y": [copy]},
            }
            new = copy
        name, port = conjunct.path[0]
        self.cells[name]["connections"][port] = [new]

    def _at(self, place: Place) -> list[Bit]:
        return self.cells[place[0]]["connections"][place[1]]

    def _source(self, path: tuple[Place, ...]) -> str:
        first, *deeper = path
        if not deeper:
            return self.cells[first[0]]["attributes"].get("src", "")
        bits = self._at(deeper[-1])
        cell = self.drivers.get(bits[0]) or deeper[-1][0]
        return self.name_of(bits) or self.cells[cell]["attributes"].get("src", "")

    def name_of(self, bits: list[Bit]) -> str:
        """Return the shortest name of a net, or of a bit of one; '' for none."""
        nets = [(name, net["bits"]) for name, net in self.nets.items() if not net["hide_name"]]
        names = [name for name, net_bits in nets if net_bits == bits]
        if len(bits) == 1:
            names = names or [f"{name}[{net_bits.index(bits[0])}]" for name, net_bits in nets if bits[0] in net_bits]
        return min(names, key=len, default="")

    def _parts(self, path: tuple[Place, ...], holds: bool) -> Iterator[tuple[tuple[Place, ...], bool]]:
        """Yield the parts of the operand at the end of ``path``, which must be ``holds``; none for an atom."""
        bits = self._at(path[-1])
        driver = self.drivers.get(bits[0]) if len(bits) == 1 else None
        if driver is None or not self.cells[driver]["attributes"].get("src", "").startswith("wrapper.sv"):
            return  # the inside of the design is not the wrapper's to say
        kind, operands = self._operands(driver)
        for port, true in operands:
            below, wanted = (*path, (driver, port)), holds == true
            if self._value(below[-1]):
                continue
            parts = list(self._parts(below, wanted))
            alone = kind == "both" or kind == ("and" if holds else "or")
            yield from parts or ([(below, wanted)] if alone else [])

    def _value(self, place: Place) -> str:
        """Return the constant at a place ('x' where nothing drives it), or ''."""
        (bit, *_) = self._at(place)
        return bit if isinstance(bit, str) else "" if bit in self.driven else "x"

    def _operands(self, name: str) -> tuple[str, list[tuple[str, bool]]]:
        """Return how a cell combines its operands, and these as (port, whether in true form); none of other cells."""
        kind, width = self.cells[name]["type"], len(self.cells[name]["connections"].get("A", ()))
        if kind == "$mux" and width == 1:
            low, high = self._value((name, "A")), self._value((name, "B"))
            ways = {
                (low, "x"): ("wire", [("A", True)]),
                ("x", high): ("wire", [("B", True)]),
                ("", ""): ("both", [("A", True), ("B", True)]),
                ("0", ""): ("and", [("S", True), ("B", True)]),
                ("1", ""): ("or", [("S", False), ("B", True)]),
                ("", "0"): ("and", [("S", False), ("A", True)]),
                ("", "1"): ("or", [("S", True), ("A", True)]),
                ("0", "1"): ("wire", [("S", True)]),
                ("1", "0"): ("wire", [("S", False)]),
            }
            return ways.get((low, high), ("", []))
        if kind == "$logic_not" or kind == "$not" and width == 1:
            return "wire", [("A", False)] if width == 1 else []
        if kind in ("$logic_and", "$logic_or") or kind in ("$and", "$or") and width == 1:
            return kind.split("_")[-1].strip("$"), [("A", True), ("B", True)]
        return "", []
