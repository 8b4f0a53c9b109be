"""Reader of SPICE subcircuits of transistors, capacitors and resistors."""

import re
from dataclasses import dataclass, field
from pathlib import Path

from talbot.models.parameters import ParameterError

_SCALE = {"t": 1e12, "g": 1e9, "meg": 1e6, "k": 1e3, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12, "f": 1e-15, "": 1.0}


@dataclass(frozen=True)
class Transistor:
    """A MOS transistor.

    size: the instance's parameters (w, l, as, ad, ps, pd, sa, sb, ...) as written, in the unit of the model set (um
    where it scales by 1u).
    """

    name: str
    model: str
    drain: str
    gate: str
    source: str
    bulk: str
    size: dict[str, float]


@dataclass(frozen=True)
class Passive:
    """A resistor (ohm) or capacitor (F) between two nodes."""

    name: str
    a: str
    b: str
    value: float


@dataclass
class Netlist:
    """A subcircuit."""

    name: str
    ports: tuple[str, ...]
    transistors: list[Transistor] = field(default_factory=list)
    capacitors: list[Passive] = field(default_factory=list)
    resistors: list[Passive] = field(default_factory=list)

    @property
    def nodes(self) -> list[str]:
        """Every node, ports first, in the order of appearance."""
        transistors = (node for t in self.transistors for node in (t.drain, t.gate, t.source, t.bulk))
        passives = (node for p in (*self.capacitors, *self.resistors) for node in (p.a, p.b))
        return list(dict.fromkeys((*self.ports, *transistors, *passives)))


def number(text: str) -> float:
    """The value of '650000u', '1e+06u', '0.42' or '10meg'. Raises ParameterError."""
    match = re.fullmatch(r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)([a-z]*)", text.strip("'{}\"").lower())
    if not match:
        raise ParameterError(f"netlist = {text!r}: must be a number")
    unit = match[2]
    prefix = "meg" if unit.startswith("meg") else unit[:1] if unit[:1] in _SCALE else ""
    return float(match[1]) * _SCALE[prefix]


def read(path: str | Path, cell: str | None = None) -> Netlist:
    """The subcircuit ``cell`` of a SPICE file, the first one by default."""
    return parse(source(path), cell, str(path))


def parse(text: str, cell: str | None = None, origin: str = "netlist") -> Netlist:
    """The same as `read` for a text; ``origin`` names it in errors. Raises ParameterError with the wrong line."""
    subcircuits = _subcircuits(text, origin)
    if cell is None:
        return next(iter(subcircuits.values()))
    if cell not in subcircuits:
        raise ParameterError(f"netlist = {origin}: has no subcircuit {cell}; it has {', '.join(subcircuits)}")
    return subcircuits[cell]


def read_all(path: str | Path) -> dict[str, Netlist]:
    """Every subcircuit of a SPICE file, by name."""
    return _subcircuits(source(path), str(path))


def subcircuit(text: str, name: str) -> str:
    """The lines of subcircuit ``name`` in a SPICE text, its .subckt and .ends included."""
    lines = _joined(text)
    first = next(i for i, line in enumerate(lines) if line.lower().startswith(".subckt") and line.split()[1] == name)
    last = next(i for i in range(first, len(lines)) if lines[i].lower().startswith(".ends"))
    return "\n".join([*lines[first : last + 1], ""])


def source(path: str | Path) -> str:
    """The text of a SPICE file; bytes that are no text become marks, which the parser refuses."""
    return Path(path).read_text(encoding="utf-8-sig", errors="replace")


def _subcircuits(text: str, origin: str) -> dict[str, Netlist]:
    netlists: dict[str, Netlist] = {}
    current, spelled = None, {}
    for line in _joined(text):
        words = re.sub(r"\s*=\s*", "=", line).split()
        card = words[0].lower()
        if card == ".subckt":
            if current is not None or len(words) < 2 or words[1] in netlists:
                raise ParameterError(
                    f"netlist = {origin}: {line!r}: must have a unique name and be outside other subcircuits"
                )
            spelled = {}
            ports = tuple(_node(w, spelled) for w in words[2:] if "=" not in w and w.lower() != "params:")
            current = netlists[words[1]] = Netlist(words[1], ports)
        elif card == ".ends":
            current = None
        elif current is not None:
            _element(current, words, line, origin, spelled)
    if not netlists:
        raise ParameterError(f"netlist = {origin}: has no .subckt")
    if current is not None:
        raise ParameterError(f"netlist = {origin}: .subckt {current.name} has no .ends")
    return netlists


def _node(name: str, spelled: dict[str, str]) -> str:
    """The node's name as first written: SPICE is case-insensitive."""
    return spelled.setdefault(name.lower(), name)


def _joined(text: str) -> list[str]:
    """The lines with their '+' continuations, without comments and empty ones."""
    lines = []
    for line in text.splitlines():
        line = re.split(r"(?:^|\s)\$|;", line)[0].strip()
        if not line or line.startswith("*"):
            continue
        if line.startswith("+") and lines:
            lines[-1] += " " + line[1:]
        else:
            lines.append(line)
    return lines


def _element(netlist: Netlist, words: list[str], line: str, origin: str, spelled: dict[str, str]) -> None:
    name, kind = words[0], words[0][0].lower()
    if kind in "xm":
        nodes = [w for w in words[1:] if "=" not in w and w != "/"]
        if len(nodes) != 5:
            raise ParameterError(f"netlist = {origin}: {line!r} must be a transistor: drain gate source bulk model")
        pairs = (w.split("=", 1) for w in words[1:] if "=" in w)
        size = {key.lower(): number(value) for key, value in pairs if key.lower() != "topography"}
        many = size.pop("m", 1)
        if many < 1 or many != int(many):
            raise ParameterError(f"netlist = {origin}: {line!r} must have a whole number m of 1 or more")
        drain, gate, source, bulk = (_node(node, spelled) for node in nodes[:4])
        netlist.transistors += [
            Transistor(f"{name}_m{k}" if k else name, nodes[4].lower(), drain, gate, source, bulk, size)
            for k in range(int(many))
        ]
    elif kind in "cr" and len(words) >= 4:
        a, b = (_node(node, spelled) for node in words[1:3])
        passive = Passive(name, a, b, number(words[3].split("=")[-1]))
        (netlist.capacitors if kind == "c" else netlist.resistors).append(passive)
    else:
        raise ParameterError(f"netlist = {origin}: {line!r} is no transistor, capacitor or resistor")
