"""Tiny Tapeout's own precheck on the archive of a finished layout, where its tools and a PDK are installed.

TT_TOOLS: tt-support-tools, with what precheck/requirements.txt lists in its .venv; PDK_ROOT as there; magic and klayout
on the PATH. The layouts are those of `make layout DESIGN=tt_...`.
"""

import os
import tarfile
from pathlib import Path

import pytest

from talbot.base.command import main
from talbot.base.paths import BUILD
from talbot.base.tools import finish
from talbot.flow.handoff import command
from talbot.flow.layout.design import design
from talbot.flow.openroad.tinytapeout import PROJECTS

TOOLS = Path(os.environ.get("TT_TOOLS", "/nowhere"))
PDK = Path(os.environ.get("PDK_ROOT", "/nowhere")) / "sky130A" / "libs.tech"
WANTED = PDK / "klayout" / "tech" / "sky130A.lyp", PDK / "magic" / "sky130A.magicrc", TOOLS / ".venv/bin/python"


@pytest.mark.timeout(1800)
@pytest.mark.skipif(not all(map(Path.exists, WANTED)), reason="TT_TOOLS or PDK_ROOT is not set to what it needs")
@pytest.mark.parametrize("name", PROJECTS)
def test_the_precheck_passes(name, tmp_path):
    if not (BUILD / "layout" / name / "summary.json").is_file():
        pytest.skip(f"TT_TOOLS alone does not do: no layout (make layout DESIGN={name})")
    assert main(command, ["--design", name, "--out", str(tmp_path)]) == 0
    with tarfile.open(tmp_path / f"{name}.tar.gz") as tar:
        tar.extractall(tmp_path, filter="data")
    gds = tmp_path / name / "tinytapeout" / f"{design(name).top}.gds"
    path = f"{TOOLS / '.venv' / 'bin'}:{os.environ['PATH']}"  # its Yosys is a wheel
    done = finish([WANTED[-1], "precheck.py", "--gds", gds, "--tech", "sky130A"], {"PATH": path}, TOOLS / "precheck")
    table = (TOOLS / "precheck" / "reports" / "results.md").read_text()
    assert not done.returncode and table.count("✅") == 15 and "❌" not in table, table
