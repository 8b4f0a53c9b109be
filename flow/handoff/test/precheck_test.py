"""Tiny Tapeout's own precheck on the archive of a finished layout, where its tools and a PDK are installed.

TT_TOOLS: tt-support-tools, with what precheck/requirements.txt lists in its .venv; PDK_ROOT as there; magic and klayout
on the PATH. The layouts are those of `make layout DESIGN=tt_...`.
"""

import os
import tarfile
from pathlib import Path

import pytest

from talbot.base.command import main
from talbot.base.tools import finish
from talbot.flow.handoff import command
from talbot.flow.layout.design import design
from talbot.flow.openroad.tinytapeout import PROJECTS

TOOLS = Path(os.environ.get("TT_TOOLS", "/nowhere"))


@pytest.mark.timeout(1800)
@pytest.mark.needs("TT_TOOLS", "PDK_ROOT", "tt-layouts", "magic", "klayout")
@pytest.mark.parametrize("name", PROJECTS)
def test_the_precheck_passes(name, tmp_path):
    assert main(command, ["--design", name, "--out", str(tmp_path)]) == 0
    with tarfile.open(tmp_path / f"{name}.tar.gz") as tar:
        tar.extractall(tmp_path, filter="data")
    gds = tmp_path / name / "tinytapeout" / f"{design(name).top}.gds"
    path = f"{TOOLS / '.venv' / 'bin'}:{os.environ['PATH']}"  # its Yosys is a wheel
    done = finish(
        [TOOLS / ".venv" / "bin" / "python", "precheck.py", "--gds", gds, "--tech", "sky130A"],
        {"PATH": path},
        TOOLS / "precheck",
    )
    table = (TOOLS / "precheck" / "reports" / "results.md").read_text()
    assert not done.returncode and table.count("✅") == 15 and "❌" not in table, table
