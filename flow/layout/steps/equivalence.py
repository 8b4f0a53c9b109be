"""RTL = netlist: proven for every input and every state, register by register, by ABC."""

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.steps import Files, Step
from talbot.base.tools import run
from talbot.signoff.netlist.equivalence import Pair, match
from talbot.signoff.netlist.netlist import Netlist
from talbot.signoff.netlist.registers import ANY, Cut

# A Liberty's flip-flop is read as two, of IQ and IQN: of these the first opt_clean keeps what its pins show
# Registers without a load stay: a macro has those, too, that the design around it does not use
GOLD = (
    "read_verilog -sv {rtl}; hierarchy -top {top}; proc; flatten -noscopeinfo; setattr -set keep 1 t:$dff; "
    "memory -nordff; techmap; simplemap; dffunmap; setattr -set keep 1 t:$_DFF_P_; opt_clean; write_json {out}"
)
GATE = (
    "read_liberty {liberty}; opt_clean; read_verilog {netlist}; hierarchy -top {top}; proc; flatten -noscopeinfo; "
    "techmap; simplemap; setattr -set keep 1 t:$_DFF_P_; opt_clean; write_json {out}"
)


@dataclass(frozen=True)
class EquivalenceParameters:
    """Parameters of `Equivalence`.

    top: module. clock, reset: its ports, the latter active at 0 if it ends in _n. seconds: time limit of a proof,
    beyond which it fails.
    """

    top: str = ""
    clock: str = "clk"
    reset: str = "reset"
    seconds: int = 600


class Equivalence(Step[EquivalenceParameters]):
    """Outputs and next states are equal as functions of inputs and states, the cells being what the Liberty says.

    A register of the RTL that the netlist lacks and that reaches an output must be a constant, or the duplicate of
    another: it is proven to be so after a reset, and to stay so (induction); the proof then uses that. One that is
    neither may hold anything: what it reaches must not depend on it. Where the Verilog leaves an output open (an array
    read beyond its end is x), so that it differs between all x at 0 and at 1, the netlist may have either; the next
    states of registers must not depend on an x.
    """

    name = "equivalence"
    inputs = {
        "rtl": "rtl",
        "netlist": "stream_out.netlist",
        "verilog": "stream_out.verilog",
        "liberty": "library.liberty",
    }
    outputs = {"summary": "equivalence.json"}
    metrics = {
        "equivalence": "",
        "registers": "",
        "constant_registers": "",
        "double_registers": "",
        "idle_registers": "",
    }
    tools = ("yosys",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p = self.parameters
        with tempfile.TemporaryDirectory(prefix="talbot-") as name:
            folder = Path(name)
            gold = self.cut(GOLD, folder / "gold.json", rtl=inputs["rtl"])
            gate = self.cut(GATE, folder / "gate.json", netlist=inputs["verilog"], liberty=inputs["liberty"])
            states, gate_states = match(gold, gate, Netlist.read(inputs["netlist"]))
            missing = sorted(gold.live() - set(states), key=int)
            pair = Pair(gold, gate, states, gate_states, folder, p.seconds).substituted(missing, p.reset)
            held, proofs = pair.given, pair.prove(p.reset)
        lacking = {gold.names[bit][0]: gold.names.get(held[bit], [held[bit]])[0] for bit in missing}
        outputs["summary"].write_text(
            json.dumps({"proofs": proofs, "missing": lacking}, indent=1) + "\n", encoding="utf-8"
        )
        constants, idle = (sum(value in values for value in held.values()) for values in (("0", "1"), (ANY,)))
        verdict = "proven" if all(proofs.values()) else "failed"
        doubles = len(held) - constants - idle
        found = {"constant_registers": constants, "double_registers": doubles, "idle_registers": idle}
        return {"equivalence": verdict, "registers": len(states), **found}

    def cut(self, script: str, path: Path, **files: Path) -> Cut:
        """The design as a Cut, by the Yosys commands ``script``."""
        run(["yosys", "-q", "-p", script.format(top=self.parameters.top, out=path, **files)])
        return Cut.read(path, self.parameters.top, self.parameters.clock)
