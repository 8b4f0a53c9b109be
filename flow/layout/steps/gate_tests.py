"""The block's own tests on a netlist: in Icarus, where an X at an output fails, or in Verilator."""

import sys
import tempfile
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.base.paths import ROOT
from talbot.base.steps import Files, Step, StepError
from talbot.base.tools import finish
from talbot.models.parameters import check_choice

NETLISTS = {"final": "stream_out.verilog", "synthesized": "synthesis.verilog"}


@dataclass(frozen=True)
class GateTestsParameters:
    """Which tests, netlist and simulator.

    folder: of the block in rtl/. names: under which its tests build the block with the parameters laid out. top: its
    module. netlist: 'final' or 'synthesized'. simulator: 'icarus' or 'verilator', which has no X.
    """

    folder: str = ""
    names: tuple[str, ...] = ()
    top: str = ""
    netlist: str = "final"
    simulator: str = "icarus"

    def __post_init__(self) -> None:
        check_choice("netlist", self.netlist, tuple(NETLISTS))
        check_choice("simulator", self.simulator, ("icarus", "verilator"))


class GateTests(Step[GateTestsParameters]):
    """The tests at zero delay: the cells are their functions; STA checks the timing."""

    inputs = {"cells": "library.verilog"}
    outputs = {"report": "tests.xml"}
    metrics = {"passed": "", "failed": ""}
    tools = ("iverilog",)

    def __init__(self, parameters: GateTestsParameters) -> None:
        super().__init__(parameters)
        self.name = f"gate_tests_{parameters.netlist}_{parameters.simulator}"
        self.inputs = {**self.inputs, "verilog": NETLISTS[parameters.netlist]}

    def starts(self) -> tuple[str, ...]:
        """The tests that pytest reads."""
        return (f"rtl/{self.parameters.folder}/test",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        p = self.parameters
        netlists = [f"--netlist={name}={inputs['verilog'].resolve()}:{p.top}" for name in p.names]
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            pytest = [sys.executable, "-m", "pytest", f"rtl/{p.folder}", "-p", "no:xdist", "-p", "no:cacheprovider"]
            files = f"--basetemp={folder}/tmp", f"--junitxml={folder}/tests.xml", f"--cells={inputs['cells'].resolve()}"
            done = finish([*pytest, *files, *netlists, f"--netlist-in={p.simulator}"], cwd=ROOT)
            outputs["report"].with_suffix(".log").write_text(done.stdout + done.stderr, encoding="utf-8")
            report = Path(folder) / "tests.xml"
            if done.returncode not in (0, 1) or not report.exists():
                raise StepError(f"{self.name}: pytest printed: {(done.stdout + done.stderr).strip().splitlines()[-1:]}")
            outputs["report"].write_bytes(report.read_bytes())
        suite = next(ET.parse(outputs["report"]).iter("testsuite"))
        count = {kind: int(suite.attrib[kind]) for kind in ("tests", "failures", "errors", "skipped")}
        failed = count["failures"] + count["errors"]
        return {"passed": count["tests"] - failed - count["skipped"], "failed": failed}
