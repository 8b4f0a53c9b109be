"""A flat design of simple gates with its registers cut: its outputs and next states as functions of inputs and states.

Two designs whose cut forms are equal, and whose registers are equal at one time, are equal from then on.
"""

import json
import random
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Any

from talbot.base.steps import StepError
from talbot.signoff.netlist.enables import LATCHES, REGISTER, pins_of, with_enables
from talbot.signoff.netlist.netlist import named_bits

Bit = int | str  # of Yosys's JSON: a net, or a constant '0', '1', 'x'
ANY = "x"
Given = Mapping[Bit, Bit]  # by Q bit what a register is assumed to hold: '0', '1', a Q bit, or ANY
Fixed = Mapping[str, str] | None  # '0' or '1' by the name of the input

# Yosys's simple gates: their pins, rows of BLIF's .names, and what they compute with all lanes of a number at once
GATES: dict[str, tuple[str, list[str], Callable[..., int]]] = {
    "$_BUF_": ("A", ["1 1"], lambda a: a),
    "$_NOT_": ("A", ["0 1"], lambda a: ~a),
    "$_AND_": ("AB", ["11 1"], lambda a, b: a & b),
    "$_NAND_": ("AB", ["11 0"], lambda a, b: ~(a & b)),
    "$_OR_": ("AB", ["00 0"], lambda a, b: a | b),
    "$_NOR_": ("AB", ["00 1"], lambda a, b: ~(a | b)),
    "$_XOR_": ("AB", ["10 1", "01 1"], lambda a, b: a ^ b),
    "$_XNOR_": ("AB", ["11 1", "00 1"], lambda a, b: ~(a ^ b)),
    "$_ANDNOT_": ("AB", ["10 1"], lambda a, b: a & ~b),
    "$_ORNOT_": ("AB", ["01 0"], lambda a, b: a | ~b),
    "$_MUX_": ("ABS", ["1-0 1", "-11 1"], lambda a, b, s: (a & ~s) | (b & s)),
}
LANES, RESET_CYCLES = 1 << 16, 4  # of the simulation that finds constant registers and duplicates
TURNS, SURE = 60, 8  # at most; without a change, the last
SPARSE = 4  # factors of a random bit, at most: what happens where a dozen bits are 0 has to happen
ALL = (1 << LANES) - 1


@dataclass(frozen=True, eq=False)
class Cut:
    """A module of Yosys's JSON; clock: name of the clock port."""

    module: dict[str, Any]
    clock: str

    @classmethod
    def read(cls, path: Path, top: str, clock: str) -> "Cut":
        """Read the module ``top``, clock gates as enables.

        Raises StepError on other cells than simple gates and flip-flops, and as `with_enables`.
        """
        module = json.loads(path.read_text(encoding="utf-8"))["modules"][top]
        wrong = {cell["type"] for cell in module["cells"].values()} - {REGISTER, *LATCHES, *GATES}
        if wrong:
            raise StepError(f"equivalence: {top} has cells of {', '.join(sorted(wrong))}")
        module["cells"] = with_enables(module["cells"], module["ports"][clock]["bits"][0])
        return cls(module, clock)

    @cached_property
    def names(self) -> dict[Bit, list[str]]:
        """All names of a bit."""
        names = {}
        for name, net in self.module["netnames"].items():
            for bit, full in named_bits(name, net):
                names.setdefault(bit, []).append(full)
        return names

    @cached_property
    def gates(self) -> dict[Bit, tuple[str, list[Bit]]]:
        """(type, input bits) by output bit."""
        return {
            cell["connections"]["Y"][0]: (cell["type"], [cell["connections"][pin][0] for pin in GATES[cell["type"]][0]])
            for cell in self.module["cells"].values()
            if cell["type"] != REGISTER
        }

    @cached_property
    def registers(self) -> dict[Bit, Bit]:
        """D bit by Q bit of every flip-flop."""
        found = [pins_of(cell) for cell in self.module["cells"].values() if cell["type"] == REGISTER]
        return {pins["Q"]: pins["D"] for pins in found}

    @cached_property
    def inputs(self) -> dict[Bit, str]:
        """Name by bit of every input except the clock."""
        return dict(self._ports("input"))

    @cached_property
    def outputs(self) -> dict[str, Bit]:
        """Bit by name of every output."""
        return {name: bit for bit, name in self._ports("output")}

    def _ports(self, direction: str) -> Iterator[tuple[Bit, str]]:
        for name, port in self.module["ports"].items():
            if port["direction"] == direction and name != self.clock:
                yield from named_bits(name, port)

    @cached_property
    def order(self) -> list[Bit]:
        """Output bits of the gates, every one after its inputs. Raises StepError on a loop."""
        sorter = TopologicalSorter({bit: pins for bit, (_, pins) in self.gates.items()})
        try:
            return [bit for bit in sorter.static_order() if bit in self.gates]
        except CycleError as error:
            bit = error.args[1][0]
            raise StepError(f"equivalence: a loop of gates at {self.names.get(bit, [bit])[0]}") from None

    def live(self) -> set[Bit]:
        """Q bits of the registers that can reach an output."""
        return set(self.registers) & self._fan_in(self.outputs.values(), self.registers)

    def cone(self, names: Iterable[str]) -> set[Bit]:
        """Bits that the outputs ``names`` come from, up to the registers."""
        return self._fan_in([self.outputs[name] for name in names])

    def substitutes(
        self, missing: Sequence[Bit], present: Collection[Bit], reset: str, refuted: Mapping[Bit, str] | None = None
    ) -> dict[Bit, Bit]:
        """Find what the registers ``missing`` (Q bits) seem to hold after a reset: '0', '1' or one of ``present``.

        A guess from random states, sparse and dense ones too: a constant is a register whose next state is what it
        holds, a duplicate has the same next state as the other wherever both hold the same; of several the one whose
        next state comes from most of the same gates, and from the fewest others. One substitute changes what others
        seem to hold: therefore in turns. A register without one holds ANY.

        refuted: constants that registers are known not to hold.
        """
        rng = random.Random(1)
        levels: dict[Bit, int] = {"0": 0, "1": ALL}
        after = {bit: rng.getrandbits(LANES) for bit in (*self.registers, *self.inputs)}
        after |= {bit: 0 if active_low(reset) else ALL for bit, name in self.inputs.items() if name == reset}
        for _ in range(RESET_CYCLES):
            after |= self._next(after)
        guess: dict[Bit, Bit | None] = {bit: "1" if after[bit] else "0" for bit in missing if after[bit] in (0, ALL)}
        wrong: dict[Bit, set[Bit]] = {bit: set() for bit in guess}
        for bit, held in (refuted or {}).items():
            guess[bit], wrong[bit] = None, {held}
        kept = 0
        cone = cache(lambda bit: self._fan_in([self.registers[bit]]))
        for turn in range(TURNS):
            now = {bit: _random(rng, turn) for bit in after}
            now |= {bit: levels[held] if held in levels else now[held] for bit, held in guess.items() if held}
            then = self._next(now)
            better: dict[Bit, Bit | None] = {}
            for bit, held in guess.items():
                if held and then[bit] != levels.get(held, then.get(held)):
                    wrong[bit].add(held)
                    held = None
                free = (other for other in present if other not in wrong[bit] and after[bit] == after[other])
                same = (other for other in free if not (then[bit] ^ then[other]) & ~(now[bit] ^ now[other]))
                better[bit] = held or min(
                    same, default=None, key=lambda other, bit=bit: _unlike(cone(bit), cone(other))
                )
            kept = kept + 1 if better == guess and None not in guess.values() else 0
            guess = better
            if kept == SURE:
                break
        return {bit: guess.get(bit) or ANY for bit in missing}

    def _fan_in(self, bits: Iterable[Bit], through: Mapping[Bit, Bit] | None = None) -> set[Bit]:
        """Bits that ``bits`` come from through gates and the registers ``through``, themselves among them."""
        seen: set[Bit] = set()
        stack = list(bits)
        while stack:
            bit = stack.pop()
            if bit not in seen:
                seen.add(bit)
                stack += self.gates[bit][1] if bit in self.gates else []
                stack += [through[bit]] if through and bit in through else []
        return seen

    def _next(self, values: dict[Bit, int]) -> dict[Bit, int]:
        """Next state by Q bit, ALL lanes of numbers, from the values of inputs and states by bit."""
        values = values | {"0": 0, "1": ALL}
        for bit in self.order:
            kind, pins = self.gates[bit]
            values[bit] = GATES[kind][2](*(values.get(pin, 0) for pin in pins)) & ALL
        return {q: values.get(d, 0) for q, d in self.registers.items()}

    def open_outputs(self) -> set[str]:
        """Names of the outputs that an x may reach."""
        cones = {name: self._fan_in([bit]) - {bit, "0", "1"} for name, bit in self.outputs.items()}
        return {name for name, cone in cones.items() if any(isinstance(bit, str) for bit in cone)}

    def network(
        self, states: Mapping[Bit, str], given: Given, fixed: Fixed = None, prefix: str = "", x: str | None = None
    ) -> tuple[list[str], Callable[[Bit], str], int]:
        """Return (lines of BLIF, function bit -> net, number of x) of the cut design; other arguments: see `blif`.

        prefix: of the nets within. x: '0' or '1', the value of every x; without, a new input each time, 'any<number>':
        what is equal for all of their values does not depend on them.
        """
        names, anything = {**self.inputs, **states}, []
        names |= {bit: f"const{(fixed or {})[name]}" for bit, name in self.inputs.items() if name in (fixed or {})}

        def net(bit: Bit) -> str:
            """Name of the net of ``bit``."""
            bit = given.get(bit, bit)
            if not isinstance(bit, int) and bit not in ("0", "1") and x is None:
                anything.append(f"any{len(anything)}")
                return anything[-1]
            if not isinstance(bit, int):
                return f"const{bit if bit in ('0', '1') else x}"
            return names.get(bit, f"{prefix}b{bit}")

        lines = []
        for bit, (kind, pins) in self.gates.items():
            lines += [f".names {' '.join(map(net, pins))} {net(bit)}", *GATES[kind][1]]
        return lines, net, len(anything)

    def blif(
        self,
        states: Mapping[Bit, str],
        given: Given,
        checked: Mapping[str, Bit],
        fixed: Fixed = None,
        unknown: int = 0,
        more: Sequence[tuple[str, Sequence[str]]] = (),
    ) -> tuple[int, str]:
        """Return (number of x, the cut design as BLIF). Its inputs: those of the design, ``states``, ``unknown`` x.

        states: names by Q bit. checked: bits or constants by the name of the output. more: (name, lines) of further
        outputs.
        """
        lines, net, used = self.network(states, given, fixed)
        for name, bit in checked.items():
            lines += [f".names {net(bit)} {name}", "1 1"]
        inputs = [*self.inputs.values(), *states.values(), *(f"any{k}" for k in range(max(used, unknown)))]
        outputs = [*checked, *(name for name, _ in more)]
        head = f".model cut\n.inputs {' '.join(inputs)}\n.outputs {' '.join(outputs)}\n.names const0\n.names const1\n1"
        return used, "\n".join([head, *lines, *(line for _, made in more for line in made), ".end", ""])


def active_low(reset: str) -> bool:
    """Whether a port of that name resets when it is 0."""
    return reset.endswith("_n")


def _unlike(cone: set[Bit], other: set[Bit]) -> tuple[int, int]:
    """How unlike two cones are: what of ``cone`` is not in the ``other``, then what is in one of them alone."""
    return len(cone - other), len(cone ^ other)


def _random(rng: random.Random, turn: int) -> int:
    """LANES random bits, from turn to turn of another share of ones: a half, a quarter, three quarters, an eighth..."""
    factors, dense = 1 + turn // 2 % SPARSE, turn % 2
    bits = ALL
    for _ in range(factors):
        bits &= rng.getrandbits(LANES)
    return bits ^ ALL if dense else bits
