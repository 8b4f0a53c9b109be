"""The block's own tests on a netlist: their Icarus level, which knows X and fails on one at any output."""

import sys
import tempfile
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

from flow.simulate.process import finish
from flow.steps import Step, StepError

ROOT = Path(__file__).parents[3]


@dataclass(frozen=True)
class GateTestsParameters:
    """folder: of the block in rtl/. names: what its tests build the block as, with the parameters laid out."""

    folder: str = ""
    names: tuple = ()
    top: str = ""


class GateTests(Step):
    """Zero delay: the cells are their functions; timing is the STA's matter."""

    name = "gate_tests"
    inputs = {"verilog": "stream_out.verilog", "cells": "library.verilog", "tests": "tests"}
    outputs = {"report": "tests.xml"}
    Parameters = GateTestsParameters
    metrics = {"passed": "", "failed": ""}
    tools = ("iverilog",)

    def run(self, inputs, outputs):
        p = self.parameters
        netlists = [f"--netlist={name}={inputs['verilog'].resolve()}:{p.top}" for name in p.names]
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            done = finish([sys.executable, "-m", "pytest", f"rtl/{p.folder}", "-p", "no:xdist", "-p",
                           "no:cacheprovider", f"--basetemp={folder}/tmp", f"--junitxml={folder}/tests.xml", *netlists,
                           f"--cells={inputs['cells'].resolve()}"], cwd=ROOT)
            outputs["report"].with_suffix(".log").write_text(done.stdout + done.stderr)
            report = Path(folder) / "tests.xml"
            if done.returncode not in (0, 1) or not report.exists():
                raise StepError(f"gate_tests: pytest said: {(done.stdout + done.stderr).strip().splitlines()[-1:]}")
            outputs["report"].write_bytes(report.read_bytes())
        suite = ET.parse(outputs["report"]).getroot().find("testsuite")
        count = {kind: int(suite.get(kind)) for kind in ("tests", "failures", "errors", "skipped")}
        failed = count["failures"] + count["errors"]
        return {"passed": count["tests"] - failed - count["skipped"], "failed": failed}
