"""RTL = netlist: proven for every input and every state, register by register, by ABC."""

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path

from base.steps import Step, StepError
from base.tools import run

from ..netlist import netlist as netlist_module
from ..netlist import registers
from ..netlist.netlist import REGISTER, Netlist, is_register
from ..netlist.registers import Cut

# Registers that nothing reads stay: a block that was laid out before has those, too, that its surroundings leave alone
GOLD = (
    "read_verilog -sv {rtl}; hierarchy -top {top}; proc; flatten; setattr -set keep 1 t:$dff; memory; techmap; "
    "simplemap; dffunmap; setattr -set keep 1 t:$_DFF_P_; opt_clean; write_json {out}"
)
GATE = (
    "read_liberty {liberty}; read_verilog {netlist}; hierarchy -top {top}; proc; flatten; techmap; simplemap; "
    "setattr -set keep 1 t:$_DFF_P_; opt_clean; write_json {out}"
)
PROOF = "cec -T {seconds} -C 100000000 {gold} {gate}"


@dataclass(frozen=True)
class EquivalenceParameters:
    """top: module. clock, reset: its ports. seconds: after which a proof is given up, which is a failure."""

    top: str = ""
    clock: str = "clk"
    reset: str = "reset"
    seconds: int = 600


class Equivalence(Step):
    """Outputs and next states are equal as functions of inputs and states, the cells being what the Liberty says.

    A register of the RTL that the netlist lacks and that reaches an output must be a constant, or the double of one
    that is there: it is shown to be so behind a reset, and to stay so (induction); that is then used in the proof. Where
    the Verilog leaves an output open (an array read beyond its end is x), so that it is another with all x at 0 than at 1,
    the netlist may have either; the next states of registers must not hang on an x.
    """

    name = "equivalence"
    inputs = {
        "rtl": "rtl",
        "netlist": "place_route.netlist",
        "verilog": "stream_out.verilog",
        "liberty": "library.liberty",
    }
    outputs = {"summary": "equivalence.json"}
    Parameters = EquivalenceParameters
    metrics = {"equivalence": "", "registers": "", "constant_registers": "", "double_registers": ""}
    uses = (registers, netlist_module)
    tools = ("yosys",)

    def run(self, inputs, outputs):
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            return self.prove(inputs, outputs, Path(folder))

    def prove(self, inputs, outputs, folder):
        p = self.parameters
        gold = self.cut(GOLD, folder / "gold.json", rtl=inputs["rtl"])
        gate = self.cut(GATE, folder / "gate.json", netlist=inputs["verilog"], liberty=inputs["liberty"])
        states, gate_states, missing = match(gold, gate, Netlist.read(inputs["netlist"]))
        held = gold.substitutes(missing, states, p.reset)
        gate_bits = {name: bit for bit, name in gate_states.items()}
        verdicts = {}
        if set(missing) == set(held):
            kept = {f"kept({k})": gold.registers[bit] for k, bit in enumerate(held)}
            as_held = {
                f"kept({k})": value if value in ("0", "1") else gate.registers[gate_bits[states[value]]]
                for k, value in enumerate(held.values())
            }
            loose = gold.open_outputs()
            wanted, made = (
                {name: bit for name, bit in cut.outputs.items() if name not in loose}
                | {f"next({name})": cut.registers[bit] for bit, name in own.items()}
                for cut, own in ((gold, states), (gate, gate_states))
            )
            verdicts["same"] = self.proof(folder, wanted | kept, made | as_held, gold, gate, states, gate_states, held)
            verdicts["open"] = self.loose(folder, sorted(loose), gold, gate, states, gate_states, held)
            verdicts["reset"] = not kept or self.proof(
                folder,
                kept,
                as_held,
                gold,
                gate,
                states | {bit: f"c{k}" for k, bit in enumerate(held)},
                gate_states | {f"c{k}": f"c{k}" for k in range(len(held))},
                {},
                {p.reset: "1"},
            )
        outputs["summary"].write_text(
            json.dumps(
                {
                    "proofs": verdicts,
                    "missing": {
                        gold.names[bit][0]: gold.names.get(held.get(bit), [held.get(bit)])[0] for bit in missing
                    },
                },
                indent=1,
            )
            + "\n"
        )
        proven = bool(verdicts) and all(verdicts.values())
        constants = sum(value in ("0", "1") for value in held.values())
        return {
            "equivalence": "proven" if proven else "failed",
            "registers": len(states),
            "constant_registers": constants,
            "double_registers": len(held) - constants,
        }

    def cut(self, script, path, **names):
        """The design as a Cut, made by the Yosys commands ``script``."""
        run(["yosys", "-q", "-p", script.format(top=self.parameters.top, out=path, **names)])
        return Cut.read(path, self.parameters.top, self.parameters.clock)

    def proof(self, folder, checked, expected, gold, gate, states, gate_states, given, fixed=None):
        """Whether the outputs ``checked`` of ``gold`` are ``expected`` of ``gate``. Raises StepError without a verdict."""
        unknown, text = gold.blif(states, given, {_net(name): bit for name, bit in checked.items()}, fixed)
        _, other = gate.blif(gate_states, {}, {_net(name): bit for name, bit in expected.items()}, fixed, unknown)
        return self.equal(folder, text, other)

    def loose(self, folder, names, gold, gate, states, gate_states, given):
        """Whether the outputs ``names`` of ``gate`` are those of ``gold`` wherever these are the same with all x at 0
        and at 1."""
        low, of_low, _ = gold.network(states, given, prefix="low_", x="0")
        high, of_high, _ = gold.network(states, given, prefix="high_", x="1")
        gates, of_gate, _ = gate.network(gate_states, {}, prefix="gate_")
        gold_lines, gate_lines = [("", low)], [("", low), ("", high), ("", gates)]
        for name in names:
            bit = gold.outputs[name]
            gold_lines.append((_net(name), [f".names {of_low(bit)} {_net(name)}", "1 1"]))
            gate_lines.append(
                (
                    _net(name),
                    [
                        f".names {of_low(bit)} {of_high(bit)} {of_gate(gate.outputs[name])} {_net(name)}",
                        "10- 1",
                        "111 1",
                        "001 1",
                    ],
                )
            )  # of the gates where the two agree
        return not names or self.equal(
            folder, *(gold.blif(states, given, {}, more=lines)[1] for lines in (gold_lines, gate_lines))
        )

    def equal(self, folder, text, other):
        """Whether two networks in BLIF are. Raises StepError without a verdict."""
        files = folder / "gold.blif", folder / "gate.blif"
        for path, blif in zip(files, (text, other), strict=True):
            path.write_text(blif)
        said = run(
            ["yosys-abc", "-s", "-c", PROOF.format(seconds=self.parameters.seconds, gold=files[0], gate=files[1])]
        )
        if ("are equivalent" in said) == ("NOT EQUIVALENT" in said):
            raise StepError(f"equivalence: ABC gave no verdict: {' '.join(said.split())[-200:]}")
        return "are equivalent" in said


def _net(name):
    """Name of an output, apart from that of any input."""
    return f"out({name})"


def match(gold, gate, netlist):
    """(states of gold, states of gate: dict Q bit -> name; Q bits of gold that gate lacks and that are live).

    Raises StepError when a flip-flop of the netlist is no register of the RTL.
    """
    by_name = {name: bit for bit in gold.registers for name in gold.names[bit]}
    nets = {name: bit for bit, names in gate.names.items() for name in names}
    states, gate_states = {}, {}
    for instance in netlist.instances:
        if is_register(instance.cell):
            register, net = instance.name.removesuffix(REGISTER), nets.get(instance.pins["q"])
            if register not in by_name or net not in gate.registers:
                raise StepError(f"equivalence: the RTL has no register {register}")
            states[by_name[register]] = gate_states[net] = f"state{len(states)}"
    if len(gate_states) != len(gate.registers):
        raise StepError("equivalence: flip-flops of the netlist share a register")
    return states, gate_states, sorted(gold.live() - set(states))
