"""Verilog -> a netlist of the library's cells, registers with the names that they have in the Verilog."""

import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from talbot.base.liberty.read import areas, most_loads, text_of, without
from talbot.base.steps import Files, Step
from talbot.base.tools import run
from talbot.flow.layout.timing.estimate import UNLOADED, setup_slack, unplaced
from talbot.models.parameters import check_int, check_real
from talbot.platforms.twins import TWIN
from talbot.signoff.netlist.buffering import buffer_fan_out, buffer_outputs
from talbot.signoff.netlist.gating import GATES, ClockCells, ClockGate, drive_registers
from talbot.signoff.netlist.netlist import Buffer, Netlist, is_register, register_names
from talbot.signoff.netlist.pins import pins

BUFFER, DRIVER = Buffer("buf_x1", "i", "q"), Buffer("buf_x4", "i", "q")
CLOCK_CELLS = [ClockCells(ClockGate(f"cg_{x}", "i", "clk", "q"), Buffer(f"buf_{x}", "i", "q")) for x in ("x1", "x2")]
CLOCK_GATE = CLOCK_CELLS[0].gate
REGISTERS = 12  # most that a clock gate or buffer drives
BARE_PF = 0.1  # load of an output above which it has its own buffer
SPARE = 1.5  # times that load: what the driver of an output without a buffer bears at least
AIM = 0.25  # share of the period that the mapper aims at: it knows one corner and no parasitics
START, LEVELS = "strash\nifraig\nscorr\ndc2\n", "if -g -K 6\nstrash\ndch -f\n"
# From the least area to the least delay: structures of fewer levels (if -g), those before them as choices (dch)
MAPPINGS = (
    "dch -f\namap\ntopo\n",
    "dch -f\nmap -B 0.9\ntopo\n",
    "&get -n\n&syn4\n&put\n" + 2 * LEVELS + "map -B 0.9\ntopo\n",
)
SHORT = 0.1  # of the period: what a mapping may be too slow by, which `repair` makes up for
LIMIT = "buffer -c -N {most}\ntopo\nupsize -D {aim:.0f}\ndnsize -D {aim:.0f}\n"  # of the fan-out
READ = """
read_verilog -sv {rtl}
design -save read
hierarchy -top {top}
proc
flatten -noscopeinfo
memory -nordff
techmap
simplemap
opt_clean
write_json {registers}
design -load read
synth -flatten -nofsm -nordff -top {top}
delete t:$scopeinfo
{gates}
dfflibmap -liberty {liberty}
write_rtlil {design}
"""
MAP = """
read_rtlil {design}
abc -D {aim:.0f} -liberty {timing} -script {mapping}
setundef -zero
hilomap -hicell one_x1 one -locell zero_x1 zero
opt_clean -purge
write_json {json}
"""


@dataclass(frozen=True)
class SynthesisParameters:
    """Parameters of `Synthesis`.

    top: module. clock: its port, '' without one. period_ns: of the clock. fan_out: most loads of a net, 0 for no limit.
    load_pf: of an output.
    """

    top: str = ""
    clock: str = "clk"
    period_ns: float = field(default=10.0, metadata={"unit": "ns"})
    fan_out: int = 16
    load_pf: float = field(default=0.0, metadata={"unit": "pF"})

    def __post_init__(self) -> None:
        check_real("period_ns", self.period_ns, 0.1, 10_000)
        check_int("fan_out", self.fan_out, 2 if self.fan_out else 0, 1000)
        check_real("load_pf", self.load_pf, 0, 1000)


class Synthesis(Step[SynthesisParameters]):
    """Yosys. Registers with an enable are behind clock gates where the library has such cells.

    FSMs keep their codes and registers their names, so that each can be compared with the Verilog.
    """

    name = "synthesis"
    inputs = {"rtl": "rtl", "liberty": "library.liberty"}
    outputs = {"netlist": "netlist.json", "verilog": "netlist.v"}
    metrics = {"cells": "", "flip_flops": "", "clock_gates": "", "cell_area_um2": "um2", "mappings": ""}
    tools = ("yosys",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, um2 = self.parameters, areas(inputs["liberty"])
        gated = bool(p.clock) and CLOCK_GATE.cell in um2
        with tempfile.TemporaryDirectory(prefix="talbot-") as name:
            folder = Path(name)
            for path, text in CLOCK_GATE.files(folder).items():
                path.write_text(text, encoding="utf-8")
            made = {"registers": folder / "registers.json", "design": folder / "design.il"}
            gates = f"script {folder / GATES}" if gated else ""
            inputs = {**inputs, **plain_cells(folder, inputs)}
            yosys(folder, READ.format(top=p.top, gates=gates, **inputs, **made))
            names = register_names(made["registers"], p.top)
            netlist, tried = self.best(folder, inputs, names, gated)
        netlist.write(outputs["netlist"])
        outputs["verilog"].write_text(netlist.verilog(), encoding="utf-8")
        area = sum(um2[i.cell] for i in netlist.instances)
        registers = sum(is_register(i.cell) for i in netlist.instances)
        clock_gates = sum(i.cell in (cells.gate.cell for cells in CLOCK_CELLS) for i in netlist.instances)
        sizes = {"cells": len(netlist.instances), "cell_area_um2": round(area, 2)}
        return sizes | {"flip_flops": registers, "clock_gates": clock_gates, "mappings": tried}

    def best(self, folder: Path, inputs: Files, names: set[str], gated: bool) -> tuple[Netlist, int]:
        """The netlist, and how many mappings were tried. names: of registers."""
        return self.mapped(folder, inputs, MAPPINGS[0], names, gated), 1

    def weak(self, inputs: Files) -> set[str]:
        """Cells that do not bear the load of an output with some to spare: OpenROAD adds no buffer between the two."""
        limits = most_loads(inputs["slowest"]) if "slowest" in inputs else {}
        return {cell for cell, most in limits.items() if most < SPARE * self.parameters.load_pf}

    def mapped(self, folder: Path, inputs: Files, mapping: str, names: set[str], gated: bool) -> Netlist:
        """The netlist of the design in ``folder``, by a mapping."""
        p, aim = self.parameters, AIM * self.parameters.period_ns * 1000
        files = {name: folder / name for name in ("mapping", "json")} | {"design": folder / "design.il"}
        limit = LIMIT.format(most=p.fan_out, aim=aim) if p.fan_out else ""
        files["mapping"].write_text(START + mapping + limit + "print_stats\n", encoding="utf-8")
        yosys(folder, MAP.format(aim=aim, timing=inputs.get("timing", inputs["liberty"]), **files))
        netlist = Netlist.from_yosys(files["json"], p.top, BUFFER, names)
        if p.load_pf > BARE_PF:
            netlist = buffer_outputs(netlist, DRIVER)
        elif p.load_pf:
            netlist = buffer_outputs(netlist, BUFFER, self.weak(inputs))
        if p.fan_out:
            netlist = buffer_fan_out(netlist, pins(netlist.ports), BUFFER, p.fan_out)
        return drive_registers(netlist, pins(netlist.ports), p.clock, CLOCK_CELLS, REGISTERS) if gated else netlist


class TimedSynthesis(Synthesis):
    """With characterized cells: the mapper sizes and buffers by their tables at the first of two corners.

    The mapping of the least area that is not too slow at the second, slowest one, else the fastest.
    """

    tools = ("yosys", "openroad")

    def __init__(self, parameters: SynthesisParameters, corner: str, slowest: str) -> None:
        super().__init__(parameters)
        self.inputs = {**self.inputs, "timing": f"timing.{corner}", "slowest": f"timing.{slowest}", "sdc": "sdc"}

    def best(self, folder: Path, inputs: Files, names: set[str], gated: bool) -> tuple[Netlist, int]:
        """See `Synthesis.best`."""
        p, found = self.parameters, []
        for mapping in MAPPINGS:
            netlist = self.mapped(folder, inputs, mapping, names, gated)
            slack = setup_slack(netlist, unplaced(netlist, p.clock), inputs["slowest"], inputs["sdc"], UNLOADED)
            if slack >= -SHORT * p.period_ns:
                return netlist, len(found) + 1
            found.append((slack, netlist))
        return max(found, key=lambda pair: pair[0])[1], len(found)


def plain_cells(folder: Path, inputs: Files) -> dict[str, Path]:
    """Liberty files for the mapper, without the twins, which place and route takes."""
    chosen = {name: folder / f"{name}.lib" for name in ("liberty", "timing") if name in inputs}
    for name, path in chosen.items():
        path.write_text(without(text_of(inputs[name]), (f"*{TWIN}",)), encoding="utf-8")
    return chosen


def yosys(folder: Path, script: str) -> None:
    """Run a script of Yosys in ``folder``. Raises ToolError."""
    (folder / "script.ys").write_text(script, encoding="utf-8")
    run(["yosys", "-q", "-s", folder / "script.ys"])
