"""The floor plan of pyproject.toml holds."""

import subprocess
import sys

from talbot.base.paths import ROOT

LINT = "import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command())"


def test_every_import_keeps_the_floor_plan():
    command = [sys.executable, "-W", "ignore", "-c", LINT, "--no-cache"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-3000:]
