"""Equivalence of a cut design and its netlist, by ABC: registers matched by name, outputs and next states compared."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from talbot.base.steps import StepError
from talbot.base.tools import run
from talbot.signoff.netlist.netlist import REGISTER, Netlist, is_register
from talbot.signoff.netlist.registers import ANY, Bit, Cut, active_low

PROOF = "cec -T {seconds} -C 100000000 {gold} {gate}"


@dataclass(frozen=True)
class Pair:
    """The RTL (gold) and the netlist (gate) with the names of their registers by Q bit.

    given: see `Cut.blif`, of registers of gold, ANY for one that has no effect. folder, seconds: for ABC.
    """

    gold: Cut
    gate: Cut
    states: dict[Bit, str]
    gate_states: dict[Bit, str]
    folder: Path
    seconds: int
    given: Mapping[Bit, Bit] = field(default_factory=dict)

    def substituted(self, missing: Sequence[Bit], reset: str) -> "Pair":
        """The same with substitutes of `Cut.substitutes` for the registers ``missing`` in the netlist, `settled`.

        Random states may miss when a register is not constant: a constant that ABC refutes is not guessed again, since
        with a wrong one other substitutes are refuted too.
        """
        refuted: dict[Bit, str] = {}
        while True:
            pair = replace(self, given=self.gold.substitutes(missing, self.states, reset, refuted))
            constants = {bit: str(value) for bit, value in pair.given.items() if value in ("0", "1")}
            lost = pair._lost(list(constants))
            if not lost:
                return pair.settled()
            refuted |= {bit: constants[bit] for bit in lost}

    def settled(self) -> "Pair":
        """The same, where a register that does not keep what is ``given`` for it may hold anything."""
        lost = self._lost(list(self.given))
        return replace(self, given={**self.given, **dict.fromkeys(lost, ANY)}).settled() if lost else self

    def _lost(self, bits: Sequence[Bit]) -> list[Bit]:
        """Those of ``bits`` that do not keep what is given for them."""
        kept, as_held = self._kept(bits)
        if not kept or self.equal(kept, as_held):
            return []
        half = len(bits) // 2
        return self._lost(bits[:half]) + self._lost(bits[half:]) if half else list(bits)

    def _kept(self, bits: Sequence[Bit]) -> tuple[dict[str, Bit], dict[str, Bit]]:
        """Next states of ``bits`` by gold, and of what is given for them by gate; none where that is anything."""
        gate_bits = {name: bit for bit, name in self.gate_states.items()}
        held = {f"kept({bit})": bit for bit in bits if self.given[bit] != ANY}
        values = {name: self.given[bit] for name, bit in held.items()}
        return (
            {name: self.gold.registers[bit] for name, bit in held.items()},
            {
                name: value if value in ("0", "1") else self.gate.registers[gate_bits[self.states[value]]]
                for name, value in values.items()
            },
        )

    def prove(self, reset: str) -> dict[str, bool]:
        """Return the verdicts of a pair that is `settled`.

        same: outputs and next states; open: the outputs that the Verilog leaves open; reset: substitutes hold after it.
        """
        gold, gate, held = self.gold, self.gate, self.given
        kept, as_held = self._kept(list(held))
        loose, idle = gold.open_outputs(), {bit for bit, value in held.items() if value == ANY}
        wanted, made = (
            {name: bit for name, bit in cut.outputs.items() if name not in loose}
            | {f"next({name})": cut.registers[bit] for bit, name in own.items()}
            for cut, own in ((gold, self.states), (gate, self.gate_states))
        )
        names = {bit: f"c{k}" for k, bit in enumerate(held)}
        gate_states = self.gate_states | {name: name for name in names.values()}
        after_reset = replace(self, states=self.states | names, gate_states=gate_states, given={})
        return {
            "same": self.equal(wanted, made),
            "open": not loose or (not idle & gold.cone(loose) and self.equal_where_defined(sorted(loose))),
            "reset": not kept or after_reset.equal(kept, as_held, {reset: "0" if active_low(reset) else "1"}),
        }

    def equal(
        self, checked: Mapping[str, Bit], expected: Mapping[str, Bit], fixed: Mapping[str, str] | None = None
    ) -> bool:
        """Whether the outputs ``checked`` of gold are ``expected`` of gate. Raises StepError without a verdict."""
        unknown, gold = self.gold.blif(self.states, self.given, {_net(k): bit for k, bit in checked.items()}, fixed)
        _, gate = self.gate.blif(self.gate_states, {}, {_net(k): bit for k, bit in expected.items()}, fixed, unknown)
        return self._abc(gold, gate)

    def equal_where_defined(self, names: Sequence[str]) -> bool:
        """Whether the outputs ``names`` are equal wherever those of gold are the same with all x at 0 and at 1."""
        low, of_low, _ = self.gold.network(self.states, self.given, prefix="low_", x="0")
        high, of_high, _ = self.gold.network(self.states, self.given, prefix="high_", x="1")
        gates, of_gate, _ = self.gate.network(self.gate_states, {}, prefix="gate_")
        gold_lines, gate_lines = [("", low)], [("", low), ("", high), ("", gates)]
        for name in names:
            bit = self.gold.outputs[name]
            gold_lines.append((_net(name), [f".names {of_low(bit)} {_net(name)}", "1 1"]))
            inputs = f"{of_low(bit)} {of_high(bit)} {of_gate(self.gate.outputs[name])}"
            # of the gates where the two agree
            gate_lines.append((_net(name), [f".names {inputs} {_net(name)}", "10- 1", "111 1", "001 1"]))
        return self._abc(*(self.gold.blif(self.states, self.given, {}, more=m)[1] for m in (gold_lines, gate_lines)))

    def _abc(self, gold: str, gate: str) -> bool:
        """Whether two networks in BLIF are equal. Raises StepError without a verdict."""
        files = self.folder / "gold.blif", self.folder / "gate.blif"
        for path, blif in zip(files, (gold, gate), strict=True):
            path.write_text(blif, encoding="utf-8")
        output = run(["yosys-abc", "-s", "-c", PROOF.format(seconds=self.seconds, gold=files[0], gate=files[1])])
        if ("are equivalent" in output) == ("NOT EQUIVALENT" in output):
            raise StepError(f"equivalence: ABC gave no verdict: {' '.join(output.split())[-200:]}")
        return "are equivalent" in output


def _net(name: str) -> str:
    """Name of an output, distinct from that of any input."""
    return f"out({name})"


def match(gold: Cut, gate: Cut, netlist: Netlist) -> tuple[dict[Bit, str], dict[Bit, str]]:
    """Return the names of the states by Q bit, of gold and of gate.

    Raises StepError when a flip-flop of the netlist is no register of the RTL.
    """
    by_name = {name: bit for bit in gold.registers for name in gold.names[bit]}
    nets = {name: bit for bit, names in gate.names.items() for name in names}
    states, gate_states = {}, {}
    for instance in netlist.instances:
        if is_register(instance.cell):
            register, net = instance.name.removesuffix(REGISTER), nets.get(instance.net("q"))
            if register not in by_name or net not in gate.registers:
                raise StepError(f"equivalence: the RTL has no register {register}")
            states[by_name[register]] = gate_states[net] = f"state{len(states)}"
    if len(gate_states) != len(gate.registers):
        raise StepError("equivalence: flip-flops of the netlist share a register")
    return states, gate_states
