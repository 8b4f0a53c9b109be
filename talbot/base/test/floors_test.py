"""The floor plan of pyproject.toml holds, and a dependency against it is found."""

import re
import shutil
import subprocess
import sys

import pytest

from talbot.base.paths import ROOT

FOLDERS = "models", "rtl", "imaging", "pixels", "cells", "signoff", "flow", "verif", "talbot"
LINT = "import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command())"


def lint(folder):
    """The process of import-linter in ``folder``."""
    command = [sys.executable, "-W", "ignore", "-c", LINT, "--no-cache"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_every_import_keeps_the_floor_plan():
    done = lint(ROOT)
    assert done.returncode == 0, done.stdout[-3000:]


# A file, an import added to it, the contract that forbids it, and what the report says
FORBIDDEN = [
    ("talbot/base/gds.py", "import talbot.platforms.foundry", "Floors:", "talbot.base.gds -> talbot.platforms.foundry"),
    (
        "models/pixel/response.py",
        "from talbot.base.files import write",
        "Floors:",
        "talbot.models.pixel.response -> talbot.base.files",
    ),
    (
        "cells/corner.py",
        "from talbot.imaging.frame import request",
        "Floors:",
        "talbot.cells.corner -> talbot.imaging.frame",
    ),
    (
        "pixels/footprints.py",
        "import talbot.imaging.decode",
        "Floors:",
        "talbot.pixels.footprints -> talbot.imaging.decode",
    ),
    (
        "signoff/geometry/boxes.py",
        "import talbot.flow.layout.chain",
        "Floors:",
        "talbot.signoff.geometry.boxes -> talbot.flow",
    ),
    ("flow/layout/design.py", "import talbot.flow.layout.chain", "No cycles", ".design -> .chain (1 import)"),
    ("verif/results.py", "import talbot.api.run", "Floors:", "talbot.verif.results -> talbot.api.run"),
    ("talbot/base/drawn.py", "import talbot", "Floors:", "talbot.base.drawn -> talbot (l."),
    (
        "rtl/tops.py",
        "from models.parameters import ArrayParameters",
        "A part has one name",
        "talbot.rtl.tops -> models",
    ),
]


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """The report of import-linter about a copy with all imports of FORBIDDEN."""
    copy = tmp_path_factory.mktemp("copy")
    for folder in FOLDERS:
        shutil.copytree(ROOT / folder, copy / folder, True, shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", copy)
    for file, line, *_ in FORBIDDEN:
        path = copy / file
        path.write_text(f"{path.read_text()}\n\n{line}\n")
    done = lint(copy)
    assert done.returncode == 1
    return done.stdout.partition("Broken contracts")[2]


@pytest.mark.parametrize("file, line, contract, chain", FORBIDDEN)
def test_a_forbidden_import_is_reported(report, file, line, contract, chain):
    parts = re.split(r"\n(.+)\n-+\n", report)  # a title and its text by turns
    assert [text for title, text in zip(parts[1::2], parts[2::2]) if title.startswith(contract) and chain in text]
