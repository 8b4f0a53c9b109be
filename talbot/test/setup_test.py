"""What set-up says of the Python that it finds."""

import os
import subprocess
import sys

import pytest

from talbot.base.paths import ROOT

SCRIPT = ROOT / "requirements" / "venv.sh"


@pytest.mark.parametrize("python, found", [("/bin/false", "nothing"), ("/nowhere/python", "nothing")])
def test_a_python_that_does_not_fit_is_refused_in_one_line(tmp_path, python, found):
    done = subprocess.run(["bash", SCRIPT, python, tmp_path / "venv", "x.lock"], capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert f"python = '{python}': must be Python 3.11 to 3.14, is {found} (make PYTHON=" in done.stderr
    assert not (tmp_path / "venv").exists()


@pytest.mark.slow
def test_another_python_of_the_system_is_found_and_named(tmp_path):
    """The first `python3` does not fit; one with a version in its name does."""
    (tmp_path / "python3").symlink_to("/bin/false")
    (tmp_path / f"python3.{sys.version_info.minor}").symlink_to(sys.executable)
    (tmp_path / "empty.lock").touch()
    done = subprocess.run(
        ["bash", SCRIPT, "python3", tmp_path / "venv", tmp_path / "empty.lock"],
        cwd=tmp_path,
        env=dict(os.environ, PATH=f"{tmp_path}:{os.environ['PATH']}"),
        capture_output=True,
        text=True,
    )
    version = ".".join(map(str, sys.version_info[:3]))
    assert f"setup: making {tmp_path / 'venv'} with Python {version} at " in done.stdout
