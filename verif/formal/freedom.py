"""Freedom of inputs: cover points, generated for every proof, of values that assumptions and wrapper must allow."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import combinations

from talbot.verif.formal.engine import UNDECIDED, Workplace
from talbot.verif.formal.netlist import Bit, Netlist
from talbot.verif.formal.proof import Proof

PAIR = " & "
SMALL = 2  # bits of a signal all values of which count


@dataclass(frozen=True)
class FreedomResult:
    """The cover points by their conditions, literals with a space between. outputs: literals of the block's outputs.

    tied: inputs at a constant. status: one of UNDECIDED, or ''. pairs: whether pairs of signals count.
    """

    reached: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    outputs: list[str] = field(default_factory=list)
    tied: list[str] = field(default_factory=list)
    status: str = ""
    wall_s: float = 0.0
    pairs: bool = True

    def problems(self, never: Iterable[str], tied: Iterable[str]) -> list[str]:
        """Return what ``never`` (regular expressions) and ``tied`` (inputs) leave open, one line each."""
        if self.status:
            return [f"inputs = {self.status}: {len(self.missing)} of their values are not reached yet"]
        alone = {name for name in self.missing if PAIR not in name}
        odd = [
            name
            for name in self.missing
            if not any(re.fullmatch(pattern, name) for pattern in never)
            and (name not in self.outputs if name in alone else alone.isdisjoint(name.split(PAIR)))
        ]
        wrong = [
            pattern
            for pattern in never
            if any(re.fullmatch(pattern, name) for name in self.reached)
            or self.pairs
            and not any(re.fullmatch(pattern, name) for name in self.missing)
        ]
        return [
            *(f"{name} = not reached: must be, or be in never" for name in odd),
            *(f"never.{pattern} = reached, or no input: must be unreachable" for pattern in wrong),
            *(f"tied = {name}: must name the inputs at a constant" for name in sorted({*self.tied} ^ {*tied})),
        ]


@dataclass(frozen=True)
class Signal:
    """An input of the wrapper or of a module under proof, a free constant of the wrapper, or an output of one bit.

    constant: it never changes. inside: it is no input of a module under proof.
    """

    name: str
    bits: list[Bit]
    output: bool = False
    constant: bool = False
    inside: bool = False


@dataclass(frozen=True)
class Literal:
    """A condition on one signal."""

    signal: Signal
    text: str
    net: Bit


def signals(netlist: Netlist, modules: Iterable[str]) -> list[Signal]:
    """Return the top's inputs and free constants, and the ports of the modules under proof that are other nets."""
    ports = netlist.module["ports"]
    inputs = [Signal(name, ports[name]["bits"]) for name in netlist.ports("input") if name != "clk"]
    inner = []
    for instance, module in netlist.instances.items():
        for port, entry in netlist.modules[module]["ports"].items() if module in modules else ():
            bits, output = netlist.nets.get(f"{instance}.{port}", {"bits": []})["bits"], entry["direction"] == "output"
            if bits and port != "clk" and (not output or len(bits) == 1):
                inner.append(Signal(f"{instance}.{port}".removeprefix("dut."), bits, output))
    for cell in netlist.of_type("$anyconst", "$anyseq"):
        bits = netlist.cells[cell]["connections"]["Y"]
        inside = all(bits != signal.bits for signal in inner)
        inputs.append(Signal(netlist.name_of(bits), bits, False, netlist.cells[cell]["type"] == "$anyconst", inside))
    nets: set[tuple[Bit, ...]] = set()
    free = [s for s in (*inputs, *inner) if any(isinstance(bit, int) for bit in s.bits)]
    tied = [s for s in inner if s not in free and not s.output]
    return [*tied, *(s for s in free if not (tuple(s.bits) in nets or nets.add(tuple(s.bits))))]


class Points:
    """The cover points of a netlist. names: of those added so far, f0, f1 ... in the netlist."""

    def __init__(self, netlist: Netlist, proof: Proof, pairs: bool = True) -> None:
        """Add the cover points of a proof to its netlist. pairs: also those of two signals."""
        self.netlist, self.never = netlist, proof.never
        self.names: list[str] = []
        inputs = signals(netlist, proof.modules)
        tied = " ".join(proof.tied).split()
        self.tied = [s.name for s in inputs if all(isinstance(b, str) for b in s.bits) or s.inside and s.name in tied]
        inputs = [s for s in inputs if s.name not in self.tied]
        reset = next((s for s in inputs if s.name == "reset"), None)
        # Counts from the first cycle after the first reset on
        low: list[Bit] = [*netlist.add("$_NOT_", A=reset.bits)] if reset else ["1"]
        (self.begun,) = netlist.before(low) if reset else low
        (self.live,) = netlist.add("$_AND_", A=[self.begun], B=low) if reset else [self.begun]
        self.reset = reset
        small = {s.name: list(self._small(s)) for s in inputs}
        self.outputs = [literal.text for s in inputs if s.output for literal in small[s.name]]
        for signal in inputs:
            for literal in (*small[signal.name], *(self._edges(signal) if len(signal.bits) > SMALL else ())):
                self._cover(literal)
        for first, second in combinations(inputs, 2) if pairs else ():
            wide = sum(len(signal.bits) > SMALL for signal in (first, second))  # with the outputs only, as busy
            if first.output + second.output == 1 or not wide and not first.output:
                for pair in ((a, b) for a in small[first.name] for b in small[second.name]):
                    self._cover(*pair)

    def _equals(self, signal: Signal, value: int) -> Bit:
        digits: list[Bit] = [str(value >> i & 1) for i in range(len(signal.bits))]
        return self.netlist.add("$eq", A=signal.bits, B=digits)[0]

    def _small(self, signal: Signal) -> Iterator[Literal]:
        """Yield every value of a small signal; that a wider one changes."""
        if len(signal.bits) <= SMALL:
            for value in range(1 << len(signal.bits)):
                yield Literal(signal, f"{signal.name}={value}", self._equals(signal, value))
        elif not (signal.constant and signal.inside):
            before = self.netlist.add("$ff", len(signal.bits), D=signal.bits)
            yield Literal(signal, f"{signal.name} changes", self.netlist.add("$ne", A=signal.bits, B=before)[0])

    def _edges(self, signal: Signal) -> Iterator[Literal]:
        """Yield the least and the largest values; both of every bit where the largest is never reached."""
        top = (1 << len(signal.bits)) - 1
        for value in (0, 1, top - 1, top):
            yield Literal(signal, f"{signal.name}={value}", self._equals(signal, value))
        for i, bit in enumerate(
            signal.bits if any(re.fullmatch(key, f"{signal.name}={top}") for key in self.never) else ()
        ):
            for value in (0, 1):
                bit_signal = Signal(f"{signal.name}.{i}", [bit])
                yield Literal(signal, f"{bit_signal.name}={value}", self._equals(bit_signal, value))

    def _cover(self, *literals: Literal) -> None:
        about_reset = any(literal.signal is self.reset for literal in literals)
        net = self.begun if about_reset else self.live
        for literal in literals:
            (net,) = self.netlist.add("$_AND_", A=[net], B=[literal.net])
        self.netlist.check("$cover", f"point_{len(self.names)}_", net)
        self.names.append(PAIR.join(literal.text for literal in literals))


def freedom(proof: Proof, texts: dict[str, str], wrapper: str, pairs: bool = True) -> FreedomResult:
    """Return the values of the inputs that are not reached within free_depth. pairs: of two inputs, too."""
    points: list[Points] = []

    def add(netlist: Netlist) -> None:
        for cell in netlist.of_type("$cover", "$assert"):
            del netlist.cells[cell]
        if proof.free_from:
            netlist.begin(proof.free_from)
        points.append(Points(netlist, proof, pairs))

    with Workplace(texts, wrapper, proof.top, proof.assumed, edit=add) as place:
        answer = place.check(proof.engines[0], ["-c", "-t", str(proof.free_depth)], proof.timeout)
    (found,) = points
    numbers = re.findall(r"Reached cover statement(?: in step \d+)? at (?:\S+: )?point_(\d+)_", answer.output)
    got = {found.names[int(number)] for number in numbers}
    return FreedomResult(
        [n for n in found.names if n in got],
        [n for n in found.names if n not in got],
        found.outputs,
        found.tied,
        answer.status if answer.status in UNDECIDED else "",
        round(answer.wall_s, 2),
        pairs,
    )
