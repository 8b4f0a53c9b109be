"""The floor plan of pyproject.toml holds, and a dependency against it is found."""

import re
import shutil
import subprocess
import sys

import pytest

from talbot.base.paths import ROOT

FOLDERS = "models", "base", "rtl", "platforms", "cells", "pixels", "flow", "verif", "talbot"
LINT = "import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command())"


def lint(folder):
    """The process of import-linter in ``folder``."""
    command = [sys.executable, "-W", "ignore", "-c", LINT, "--no-cache"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_every_import_keeps_the_floor_plan():
    done = lint(ROOT)
    assert done.returncode == 0, done.stdout[-3000:]


@pytest.mark.parametrize(
    "file, line, contract",
    [
        ("base/gds.py", "import talbot.platforms.foundry", "Floors"),
        ("models/pixel/response.py", "from talbot.base.files import write", "Floors"),
        ("cells/corner.py", "from talbot.flow.frame import request", "Floors"),
        ("pixels/footprints.py", "import talbot.cells.corner", "Floors"),
        ("flow/layout/geometry/boxes.py", "import talbot.flow.layout.chain", "cycles"),
        ("verif/results.py", "import talbot.api.run", "Floors"),
        ("base/gds.py", "import talbot", "Floors"),
        ("rtl/tops.py", "from models.parameters import ArrayParameters", "one name"),
    ],
)
def test_an_import_against_it_is_found(tmp_path, file, line, contract):
    for folder in FOLDERS:
        shutil.copytree(ROOT / folder, tmp_path / folder, True, shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    path = tmp_path / file
    path.write_text(f"{path.read_text()}\n\n{line}\n")
    done = lint(tmp_path)
    assert done.returncode == 1 and re.search(rf"{contract}.* BROKEN", done.stdout)
