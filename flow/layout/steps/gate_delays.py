"""The stimulus replayed through the final netlist in Icarus with the delays of a corner, at the clock's full rate."""

import json
from dataclasses import dataclass, field
from typing import Any

from talbot.base.steps import Files, StepError
from talbot.flow.layout.steps.corner import CornerStep
from talbot.flow.layout.timing.delays import read
from talbot.flow.layout.timing.replay import Timing, replay
from talbot.models.parameters import check_real
from talbot.signoff.netlist.netlist import Netlist

CONSTANTS = {"zero", "one", "HI", "LO", "DIODE"}  # pins of cells without a path


@dataclass(frozen=True)
class GateDelaysParameters:
    """Corner, period of the clock, I/O delays as shares of it."""

    corner: str = ""
    period_ns: float = field(default=20.0, metadata={"unit": "ns"})
    input_delay: float = 0.2
    output_delay: float = 0.2

    def __post_init__(self) -> None:
        check_real("period_ns", self.period_ns, 0.5, 1e4)
        for name in ("input_delay", "output_delay"):
            check_real(name, getattr(self, name), 0, 0.5)


class GateDelays(CornerStep[GateDelaysParameters]):
    """Outputs and timing checks of the whole trace: passed without a wrong output, an X or a violation.

    Annotated: all path delays with those of the nets (timing/delays.py), and setup and hold of every register.
    setup_margin_ns, hold_margin_ns: the least that occurred; STA at this corner may report no larger slack. activity:
    transitions a cycle, glitches included, and share of time at 1 of every net.
    """

    name = "gate_delays_{corner}"
    inputs = {"netlist": "stream_out.netlist", "cells": "library.verilog", "sdf": "sta_{corner}.sdf"}
    inputs |= {"head": "stimulus.head", "trace": "stimulus.trace"}
    outputs = {"activity": "activity.json"}
    metrics = {"passed": "", "failed": "", "cycles": "", "paths": "", "setup_margin_ns": "ns", "hold_margin_ns": "ns"}
    tools = ("iverilog",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p, folder = self.parameters, outputs["activity"].parent
        netlist, delays = Netlist.read(inputs["netlist"]), read(inputs["sdf"].read_text(encoding="utf-8"))
        lacking = [i.name for i in netlist.instances if set(i.pins) - CONSTANTS and i.name not in delays.paths]
        if lacking:
            raise StepError(f"{self.name}: the SDF has no delay of {', '.join(lacking[:5])}")
        timing, cells = Timing(p.period_ns, p.input_delay, p.output_delay), inputs["cells"].read_text(encoding="utf-8")
        found = replay(netlist, cells, inputs["head"], timing, folder, delays, count=True)
        (folder / "verdict.log").write_text("\n".join((*found.first, *found.late[:100])) + "\n", encoding="utf-8")
        for name in ("cells", "netlist", "delays", "bench"):
            (folder / f"{name}.log").unlink()
        outputs["activity"].write_text(json.dumps(found.activity, indent=0) + "\n", encoding="utf-8")
        good, margins = not found.wrong and not found.late, found.margins or (0.0, 0.0)
        paths, (setup, hold) = sum(map(len, delays.paths.values())), margins
        counts = {"passed": int(good), "failed": int(not good), "cycles": found.cycles, "paths": paths}
        return counts | {"setup_margin_ns": round(setup, 4), "hold_margin_ns": round(hold, 4)}
