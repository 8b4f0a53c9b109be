"""Faults that can be planted in the circuit of a row, by name."""

from dataclasses import dataclass, replace

from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.netlist import Circuit

KINDS = {
    "comparator": "the comparator inputs of lane {} are swapped",
    "capacitor": "lane {} has no capacitor of bit {}",
    "diodes": "the diode lines of column {} are swapped",
    "row": "the row's read line is cut before column {}",
}


@dataclass(frozen=True)
class Fault:
    """A fault. kind: of KINDS; where: numbers of the lane, bit or column that it names."""

    kind: str
    where: tuple[int, ...]

    @classmethod
    def parse(cls, text: str) -> "Fault":
        """Return the fault of a text like capacitor:0:7. Raises ParameterError."""
        kind, *where = text.split(":")
        if kind not in KINDS or len(where) != KINDS[kind].count("{}") or not all(w.isdecimal() for w in where):
            forms = ", ".join(kind + ":n" * words.count("{}") for kind, words in KINDS.items())
            raise ParameterError(f"fault = {text!r}: must be one of {forms}")
        return cls(kind, tuple(map(int, where)))

    @property
    def name(self) -> str:
        """In words."""
        return KINDS[self.kind].format(*self.where)

    def of_lane(self, lane: Circuit, number: int) -> Circuit:
        """Lane ``number`` of the circuit: with the fault if it is there, else as it is."""
        if self.kind not in ("comparator", "capacitor") or self.where[0] != number:
            return lane
        parts = []
        for part in lane.instances:
            if part.name == self.kind:
                other, top, *rest = part.nodes
                part = part._replace(nodes=(top, other, *rest))
            if part.name == "dac" and self.kind == "capacitor":
                part = part._replace(circuit=replace(part.circuit.without(f"bit{self.where[1]}"), name="dac_faulty"))
            parts.append(part)
        return replace(lane, name="sar_lane_faulty", instances=tuple(parts))
