"""A SPICE subcircuit of transistors, capacitors and resistors, read into plain records."""

import re
from dataclasses import dataclass, field
from pathlib import Path

from models.parameters import ParameterError

_SCALE = {"t": 1e12, "g": 1e9, "meg": 1e6, "k": 1e3, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12, "f": 1e-15, "": 1.0}


@dataclass(frozen=True)
class Transistor:
    """name, model: as in the netlist; size: the instance's parameters (w, l, as, ad, ps, pd, sa, sb, ...) as written,

    in the unit of the model set (um where it scales by 1u).
    """

    name: str
    model: str
    drain: str
    gate: str
    source: str
    bulk: str
    size: dict


@dataclass(frozen=True)
class Passive:
    """A resistor (ohm) or capacitor (F) between two nodes."""

    name: str
    a: str
    b: str
    value: float


@dataclass
class Netlist:
    """A subcircuit. ports: in order."""

    name: str
    ports: tuple
    transistors: list = field(default_factory=list)
    capacitors: list = field(default_factory=list)
    resistors: list = field(default_factory=list)

    @property
    def nodes(self):
        """Every node, ports first, in the order of appearance."""
        found = dict.fromkeys(self.ports)
        for t in self.transistors:
            found.update(dict.fromkeys((t.drain, t.gate, t.source, t.bulk)))
        for p in (*self.capacitors, *self.resistors):
            found.update(dict.fromkeys((p.a, p.b)))
        return list(found)


def number(text):
    """'650000u', '1e+06u', '0.42', '10meg' -> float. Raises ParameterError."""
    match = re.fullmatch(r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)([a-z]*)", text.strip("'{}\"").lower())
    if not match:
        raise ParameterError(f"netlist = {text!r}: must be a number")
    unit = match[2]
    prefix = "meg" if unit.startswith("meg") else unit[:1] if unit[:1] in _SCALE else ""
    return float(match[1]) * _SCALE[prefix]


def read(path, cell=None):
    """The subcircuit ``cell`` (None: the only or first one) of a SPICE file: Netlist."""
    return parse(Path(path).read_text(), cell, str(path))


def parse(text, cell=None, origin="netlist"):
    """As `read`, of a text. Raises ParameterError naming the line that is not understood."""
    found = _subcircuits(text, origin)
    if cell is None:
        return next(iter(found.values()))
    if cell not in found:
        raise ParameterError(f"netlist = {origin}: has no subcircuit {cell}; it has {', '.join(found)}")
    return found[cell]


def read_all(path):
    """Every subcircuit of a SPICE file: name -> Netlist."""
    return _subcircuits(Path(path).read_text(), str(path))


def subcircuit(text, name):
    """The lines of subcircuit ``name`` in a SPICE text, its .subckt and .ends included."""
    lines = _joined(text)
    first = next(i for i, line in enumerate(lines) if line.lower().startswith(".subckt") and line.split()[1] == name)
    last = next(i for i in range(first, len(lines)) if lines[i].lower().startswith(".ends"))
    return "\n".join([*lines[first:last + 1], ""])


def _subcircuits(text, origin):
    found, current = {}, None
    for line in _joined(text):
        words = re.sub(r"\s*=\s*", "=", line).split()
        card = words[0].lower()
        if card == ".subckt":
            ports = tuple(w for w in words[2:] if "=" not in w and w.lower() != "params:")
            current = found[words[1]] = Netlist(words[1], ports)
        elif card == ".ends":
            current = None
        elif current is not None:
            _element(current, words, line, origin)
    if not found:
        raise ParameterError(f"netlist = {origin}: has no .subckt")
    return found


def _joined(text):
    """Lines with their '+' continuations, without comments and empty ones."""
    lines = []
    for line in text.splitlines():
        line = line.split("$")[0].strip()
        if not line or line.startswith("*"):
            continue
        if line.startswith("+") and lines:
            lines[-1] += " " + line[1:]
        else:
            lines.append(line)
    return lines


def _element(netlist, words, line, origin):
    name, kind = words[0], words[0][0].lower()
    if kind in "xm":
        nodes = [w for w in words[1:] if "=" not in w]
        if len(nodes) != 5:
            raise ParameterError(f"netlist = {origin}: {line!r} must be a transistor: drain gate source bulk model")
        pairs = (w.split("=") for w in words[1:] if "=" in w)
        size = {key.lower(): number(value) for key, value in pairs if key.lower() != "topography"}
        netlist.transistors.append(Transistor(name, nodes[4], *nodes[:4], size))
    elif kind in "cr" and len(words) >= 4:
        (netlist.capacitors if kind == "c" else netlist.resistors).append(
            Passive(name, words[1], words[2], number(words[3].split("=")[-1])))
    else:
        raise ParameterError(f"netlist = {origin}: {line!r} is no transistor, capacitor or resistor")
