"""A flat design of simple gates with its registers cut: its outputs and next states as functions of inputs and states.

Two designs whose cut forms are equal, and that agree in what their registers hold at one time, agree for ever.
"""

import json
import random
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from base.steps import StepError

from .netlist import named_bits

# Yosys's simple gates: their pins, rows of BLIF's .names, and what they compute with all lanes of a number at once
GATES = {
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
REGISTER = "$_DFF_P_"
LANES, RESET_CYCLES = 1 << 16, 4  # of the simulation that looks for constant registers, and for doubles
TURNS, SURE = 60, 5  # at most; without a change, the last
ALL = (1 << LANES) - 1


@dataclass(frozen=True, eq=False)
class Cut:
    """module: of Yosys's JSON. clock: name of the clock port."""

    module: dict
    clock: str

    @classmethod
    def read(cls, path, top, clock):
        """Raises StepError on anything but simple gates and flip-flops at the rising edge of the clock."""
        made = cls(json.loads(Path(path).read_text())["modules"][top], clock)
        wrong = {cell["type"] for cell in made.module["cells"].values()} - {REGISTER, *GATES}
        if wrong:
            raise StepError(f"equivalence: {top} has cells of {', '.join(sorted(wrong))}")
        return made

    @cached_property
    def names(self):
        """All names of a bit: dict bit -> list."""
        names = {}
        for name, wire in self.module["netnames"].items():
            for bit, full in named_bits(name, wire):
                names.setdefault(bit, []).append(full)
        return names

    @cached_property
    def gates(self):
        """dict output bit -> (type, input bits)."""
        return {
            cell["connections"]["Y"][0]: (cell["type"], [cell["connections"][pin][0] for pin in GATES[cell["type"]][0]])
            for cell in self.module["cells"].values()
            if cell["type"] != REGISTER
        }

    @cached_property
    def registers(self):
        """dict Q bit -> D bit of every flip-flop. Raises StepError for one that is not on the clock."""
        clock, made = self.module["ports"][self.clock]["bits"][0], {}
        for name, cell in self.module["cells"].items():
            if cell["type"] == REGISTER:
                pins = {pin: bits[0] for pin, bits in cell["connections"].items()}
                if self._behind(pins["C"]) != (clock, False):
                    raise StepError(f"equivalence: flip-flop {name} is not on the rising edge of {self.clock}")
                made[pins["Q"]] = pins["D"]
        return made

    def _behind(self, bit, inverted=False):
        """(bit, whether inverted) that ``bit`` is a copy of, through buffers and inverters."""
        while bit in self.gates and self.gates[bit][0] in ("$_BUF_", "$_NOT_"):
            kind, (bit,) = self.gates[bit]
            inverted ^= kind == "$_NOT_"
        return bit, inverted

    @cached_property
    def inputs(self):
        """dict bit -> name of every input but the clock."""
        return {
            bit: _bit(name, index, port)
            for name, port in self.module["ports"].items()
            if port["direction"] == "input" and name != self.clock
            for index, bit in enumerate(port["bits"])
        }

    @cached_property
    def outputs(self):
        """dict name -> bit of every output."""
        return {
            _bit(name, index, port): bit
            for name, port in self.module["ports"].items()
            if port["direction"] == "output"
            for index, bit in enumerate(port["bits"])
        }

    @cached_property
    def order(self):
        """Output bits of the gates, every one behind its inputs. Raises StepError on a loop."""
        order, state = [], {}
        for root in self.gates:
            stack = [root]
            while stack:
                bit = stack[-1]
                below = [b for b in self.gates[bit][1] if b in self.gates and state.get(b) != 2]
                if state.get(bit) == 2:
                    stack.pop()
                elif not below:
                    state[bit] = 2
                    order.append(bit)
                    stack.pop()
                elif state.get(bit) == 1 and any(state.get(b) == 1 for b in below):
                    raise StepError(f"equivalence: a loop of gates at {self.names.get(bit, [bit])[0]}")
                else:
                    state[bit] = 1
                    stack += below
        return order

    def live(self):
        """Q bits of the registers that can reach an output: set."""
        seen, stack = set(), list(self.outputs.values())
        while stack:
            bit = stack.pop()
            if bit not in seen:
                seen.add(bit)
                stack += (
                    self.gates[bit][1] if bit in self.gates else [self.registers[bit]] if bit in self.registers else []
                )
        return seen & set(self.registers)

    def substitutes(self, missing, present, reset):
        """What the registers ``missing`` (Q bits) seem to hold whenever reset was once given: dict bit -> '0', '1' or
        one of the registers ``present``, of those for which there is such a thing.

        A guess from random states: a constant is a register whose next state is what it holds, a double has the same
        next state as the other wherever both hold the same; of several the one whose next state comes from most of the
        same gates. What one is held to be, others see: in turns, therefore.
        """
        rng, levels = random.Random(1), {"0": 0, "1": ALL}
        behind = {bit: rng.getrandbits(LANES) for bit in (*self.registers, *self.inputs)}
        behind |= {bit: ALL for bit, name in self.inputs.items() if name == reset}
        for _ in range(RESET_CYCLES):
            behind |= self._next(behind)
        guess = {bit: "1" if behind[bit] else "0" for bit in missing if behind[bit] in (0, ALL)}
        wrong, kept = {bit: set() for bit in guess}, 0
        for _ in range(TURNS):
            now = {bit: rng.getrandbits(LANES) for bit in behind}
            now |= {bit: levels[held] if held in levels else now[held] for bit, held in guess.items() if held}
            then = self._next(now)
            better = {}
            for bit, held in guess.items():
                if held and then[bit] != levels.get(held, then.get(held)):
                    wrong[bit].add(held)
                    held = None
                better[bit] = held or min(
                    (
                        other
                        for other in present
                        if other not in wrong[bit]
                        and behind[bit] == behind[other]
                        and not (then[bit] ^ then[other]) & ~(now[bit] ^ now[other])
                    ),
                    default=None,
                    key=lambda other, bit=bit: len(self._cone(bit) ^ self._cone(other)),
                )
            kept = kept + 1 if better == guess and None not in guess.values() else 0
            guess = better
            if kept == SURE:
                break
        return {bit: held for bit, held in guess.items() if held}

    @cache
    def _cone(self, bit):
        """Bits that the next state of a register (Q bit) comes from."""
        return self._behind_all(self.registers[bit])

    def _behind_all(self, bit):
        """Bits that ``bit`` comes from through gates, itself among them."""
        seen, stack = set(), [bit]
        while stack:
            here = stack.pop()
            if here not in seen:
                seen.add(here)
                stack += self.gates[here][1] if here in self.gates else []
        return frozenset(seen)

    def _next(self, values):
        """dict Q bit -> next state, ALL lanes of numbers, from the dict bit -> value of inputs and states."""
        values = values | {"0": 0, "1": ALL}
        for bit in self.order:
            kind, pins = self.gates[bit]
            values[bit] = GATES[kind][2](*(values.get(pin, 0) for pin in pins)) & ALL
        return {q: values.get(d, 0) for q, d in self.registers.items()}

    def open_outputs(self):
        """Names of the outputs that an x may reach: set."""
        found = set()
        for name, bit in self.outputs.items():
            cone = self._behind_all(bit)
            if any(
                not isinstance(pin, int) and pin not in ("0", "1")
                for here in cone & set(self.gates)
                for pin in self.gates[here][1]
            ):
                found.add(name)
        return found

    def network(self, states, given, fixed=None, prefix="", x=None):
        """(lines of BLIF, function bit -> net, number of x) of the cut design; parameters as of `blif`.

        prefix: of the nets within. x: '0' or '1', what an x is; without, a new input each time, 'any<number>': what is
        equal for all of their values does not depend on them.
        """
        wire, anything = self.inputs | states, []
        wire |= {bit: f"const{(fixed or {})[name]}" for bit, name in self.inputs.items() if name in (fixed or {})}

        def net(bit):
            bit = given.get(bit, bit)
            if not isinstance(bit, int) and bit not in ("0", "1") and x is None:
                anything.append(f"any{len(anything)}")
                return anything[-1]
            if not isinstance(bit, int):
                return f"const{bit if bit in ('0', '1') else x}"
            return wire.get(bit, f"{prefix}b{bit}")

        lines = []
        for bit, (kind, pins) in self.gates.items():
            lines += [f".names {' '.join(map(net, pins))} {net(bit)}", *GATES[kind][1]]
        return lines, net, len(anything)

    def blif(self, states, given, checked, fixed=None, unknown=0, more=()):
        """(number of its x, the cut design as BLIF): its inputs are those of the design, ``states`` and ``unknown`` x.

        states: dict Q bit -> name. given: dict Q bit -> '0', '1' or a Q bit, what a register is taken to hold. checked:
        dict name -> bit or constant, the outputs. fixed: dict input name -> '0' or '1'. more: pairs (name of a further
        output, lines that make it).
        """
        lines, net, used = self.network(states, given, fixed)
        for name, bit in checked.items():
            lines += [f".names {net(bit)} {name}", "1 1"]
        inputs = [*self.inputs.values(), *states.values(), *(f"any{k}" for k in range(max(used, unknown)))]
        outputs = [*checked, *(name for name, _ in more)]
        return used, "\n".join(
            [
                ".model cut",
                ".inputs " + " ".join(inputs),
                ".outputs " + " ".join(outputs),
                ".names const0",
                ".names const1",
                "1",
                *lines,
                *(line for _, made in more for line in made),
                ".end",
                "",
            ]
        )


def _bit(name, index, port):
    return name if len(port["bits"]) == 1 else f"{name}[{index}]"
