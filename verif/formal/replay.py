"""The trace of a failed proof: its waveform, and a test that replays it in Verilator with the wrapper's assertions.

The flat design of a proof becomes Verilog: an output for each assertion and each assumption, high where it is violated,
and an input for each free value.
"""

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from talbot.base.environment import of_tools
from talbot.base.files import write
from talbot.base.tools import ToolError
from talbot.rtl.harness.ports import Port, places, split
from talbot.verif.formal import design, manifest
from talbot.verif.formal.engine import FAILED, PASSED, Workplace, smt2
from talbot.verif.formal.netlist import Netlist
from talbot.verif.formal.proof import RESET, Proof
from talbot.verif.formal.prove import failed
from talbot.verif.verilated.program import compile_program

VERILOG = "setundef -undriven -zero", "opt_clean", "write_verilog -noattr checked.v"
TEST = '''"""{what}.

{run}
"""

from talbot.verif.formal.replay import failures

# Registers that begin with a value; all others with their reset value, or any
START = {start}
# Inputs of {top} ({wrapper}), cycle by cycle
CYCLES = [
{cycles}
]


def test_{name}():
    assert failures("{name}", CYCLES, START) == []
'''


@dataclass(frozen=True)
class Trace:
    """The shortest trace with a violated assertion. failing: these. cycles: inputs by name.

    start: registers that begin with a value, for a trace of an induction step. vcd: the waveform.
    """

    failing: list[str]
    cycles: list[dict[str, int]]
    start: dict[str, int]
    vcd: str

    @property
    def origin(self) -> str:
        """Return where the trace begins."""
        return "a state that may be unreachable: an invariant may be missing" if self.start else "reset"


@dataclass
class Checked:
    """A flat design with its assertions as outputs. labels: of these outputs, in their order."""

    ports: list[Port] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)

    def observe(self, netlist: Netlist, start: Mapping[str, int]) -> None:
        """Turn the assertions and assumptions of a netlist into outputs, its free values into inputs.

        start: values with which registers begin; a name that is no register is ignored.
        """
        for cell in netlist.of_type("$anyconst", "$anyseq"):
            bits = netlist.cells.pop(cell)["connections"]["Y"]
            netlist.module["ports"][netlist.name_of(bits)] = {"direction": "input", "bits": bits}
        for label in netlist.of_type("$assert", "$assume"):
            pins = netlist.cells.pop(label)["connections"]
            if label != RESET:
                wrong = netlist.add("$_AND_", A=pins["EN"], B=netlist.add("$_NOT_", A=pins["A"]))
                name = f"check{len(self.labels)}"
                netlist.module["ports"][name] = {"direction": "output", "bits": wrong}
                netlist.nets[name] = {"hide_name": 0, "bits": wrong, "attributes": {}}
                self.labels.append(label)
        for cell in netlist.of_type("$cover"):
            del netlist.cells[cell]
        for name, value in start.items():
            if name in netlist.nets:
                net = netlist.nets[name]
                net["attributes"]["init"] = f"{value:0{len(net['bits'])}b}"
        for name in (*netlist.ports("input"), *netlist.ports("output")):
            port = netlist.module["ports"][name]
            if name != "clk" and (port["direction"] == "input" or name.startswith("check")):
                self.ports.append(Port(name, len(port["bits"]), port["direction"] == "output"))


def violations(
    proof: Proof, texts: dict[str, str], wrapper: str, cycles: Sequence[Mapping[str, int]], start: Mapping[str, int]
) -> list[list[str]]:
    """Return the labels of the violated assertions and assumptions in each cycle, simulated by Verilator.

    texts, wrapper: of the design (`design`). cycles: inputs; those of another name are ignored, others are 0. start:
    registers that begin with a value, and free constants.
    """
    checked = Checked()
    with Workplace(
        texts, wrapper, proof.top, proof.assumed, VERILOG, lambda netlist: checked.observe(netlist, start)
    ) as place:
        verilog = (place.path / "checked.v").read_text(encoding="utf-8")
    program = compile_program(verilog, proof.top, checked.ports)
    inputs, outputs = split(checked.ports)

    def value(cycle: Mapping[str, int], port: Port) -> int:
        return cycle.get(port.name, start.get(port.name, 0))

    lines = [
        f"{int(number > 0)} {sum(value(cycle, port) << low for port, low in places(inputs).items()):x}\n"
        for number, cycle in enumerate(cycles)
    ]
    command = [program.folder / "replay", "--drive", "0", "--settled"]
    answer = subprocess.run(command, input="".join(lines), capture_output=True, text=True, env=of_tools())
    rows = answer.stdout.split()
    if answer.returncode or len(rows) != len(cycles):
        raise ToolError(f"{proof.name}: the simulation ended early: {answer.stdout[-300:]}{answer.stderr[-300:]}")
    return [
        [label for label, port in zip(checked.labels, outputs, strict=True) if row[-1 - places(outputs)[port]] == "1"]
        for row in rows
    ]


def failures(name: str, cycles: Sequence[Mapping[str, int]], start: Mapping[str, int] | None = None) -> list[str]:
    """Return 'label in cycle n' for each assertion that the present design violates in a trace of proof ``name``.

    A trace counts up to the first violated assumption. One from a state, ``start``, counts where all assertions hold in
    all cycles but the last: another invariant shows that the state is unreachable.
    """
    (proof,) = (proof for proof in manifest.every() if proof.name == name)
    rows = violations(proof, design.exported(proof), design.wrapper(proof), cycles, start or {})
    violated = []
    for number, row in enumerate(rows):
        if any(label.split(".")[-1] in proof.assumptions for label in row):
            break
        violated += [f"{label} in cycle {number}" for label in row]
        if start and row and number < len(rows) - 1:
            return []
    return violated


def shortest(proof: Proof, engine: str, texts: dict[str, str], wrapper: str) -> Trace | None:
    """Return the shortest trace: of a property from reset, else of an invariant, else of the induction step.

    None: the proof holds. Raises ToolError for a timeout.
    """
    longest = max(proof.depth, proof.twin_depth) if proof.method == "induction" else proof.depth
    tries = [(False, ["-t", str(longest)]), (True, ["-t", str(proof.depth)])]
    if proof.method == "induction":
        tries.append((True, ["-i", "-t", str(proof.depth)]))
    traces, undecided = [], ""
    for invariants, options in reversed(tries):  # the proof first: where it holds, there is nothing to search for
        if not (invariants or traces):
            break
        with Workplace(texts, wrapper, proof.top, proof.assumed, smt2(invariants=invariants)) as place:
            dumps = ["--dump-vcd", "trace.vcd", "--dump-yw", "trace.yw"]
            answer = place.check(engine, [*options, *dumps], proof.timeout)
            if answer.status == FAILED:
                witness = json.loads((place.path / "trace.yw").read_text(encoding="utf-8"))
                vcd = (place.path / "trace.vcd").read_text(encoding="utf-8")
                cycles, start = _steps(witness)
                if "-i" not in options:  # then these are free constants alone
                    cycles, start = [start | cycle for cycle in cycles], {}
                traces.append(Trace(failed(answer), cycles, start, vcd))
            elif answer.status != PASSED:
                undecided = answer.status
    if undecided and not traces:
        raise ToolError(f"{proof.name} = {undecided} by {engine}: no trace within {proof.timeout:g} s")
    return traces[-1] if traces else None


def _steps(witness: dict[str, Any]) -> tuple[list[dict[str, int]], dict[str, int]]:
    """Return the inputs of each cycle, and what constants and registers are in the first, of a Yosys witness."""
    signals = [
        (".".join(part.removeprefix("\\") for part in s["path"]), s["width"], s["offset"], s["init_only"])
        for s in witness["signals"]
    ]
    cycles, start = [], {}
    for number, step in enumerate(witness["steps"]):
        bits, low, values = step["bits"][::-1], 0, {}
        for name, width, offset, init in signals:
            if init and number:
                continue
            text = bits[low : low + width][::-1].replace("x", "0").replace("?", "0")
            into = start if init else values
            into[name] = into.get(name, 0) | int(text, 2) << offset
            low += width
        cycles.append({name: value for name, value in values.items() if name != "clk"})
    return cycles, start


def show(proof: Proof, out: Path) -> str | None:
    """Write <proof>.vcd and <proof>_test.py of the shortest trace to folder ``out``.

    Returns what fails, the waveform and the line that replays it; None where the proof holds.
    """
    texts, wrapper = design.exported(proof), design.wrapper(proof)
    trace = shortest(proof, proof.engines[0], texts, wrapper)
    if not trace:
        return None
    vcd, test = out / f"{proof.name}.vcd", out / f"{proof.name}_test.py"
    run = f"{os.path.relpath(sys.executable)} -m pytest {os.path.relpath(test)}"
    what = f"{', '.join(trace.failing)} of {proof.name} fails in cycle {len(trace.cycles) - 1}, from {trace.origin}"
    write(vcd, trace.vcd)
    text = TEST.format(
        what=what,
        run=run,
        start=json.dumps(trace.start),
        top=proof.top,
        wrapper=os.path.relpath(proof.wrapper),
        cycles="\n".join(f"    {json.dumps(cycle)}," for cycle in trace.cycles),
        name=proof.name,
    )
    write(test, text)
    return f"{what}\nwaveform: {os.path.relpath(vcd)}\nreplay: {run}"
