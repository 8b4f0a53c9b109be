"""Folders kept whole: made once, gone when making fails, and what a killed process left is cleared away."""

import os
import shutil
import subprocess
import sys

import pytest

from talbot.base.cache import CONTENT, cached
from talbot.base.files import PART


def test_it_is_made_once(tmp_path):
    made = []

    def make(part):
        made.append(part)
        (part / "file").write_text("whole")

    for _ in range(2):
        assert (cached(tmp_path / "kept", make) / "file").read_text() == "whole"
    assert len(made) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["kept"]


def test_nothing_is_left_of_what_fails(tmp_path):
    def make(part):
        (part / "file").write_text("half")
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        cached(tmp_path / "kept", make)
    assert not list(tmp_path.iterdir())


def test_what_a_killed_process_left_goes_and_what_is_being_made_stays(tmp_path):
    script = (
        "import os, signal, sys; from talbot.base.cache import CONTENT, cached; "
        "cached(sys.argv[1], lambda part: os.kill(os.getpid(), signal.SIGKILL))"
    )
    subprocess.run([sys.executable, "-c", script, tmp_path / "killed"], check=False)
    assert [path.name.startswith(PART) for path in tmp_path.iterdir()] == [True]
    other = tmp_path / f"{PART}{os.getppid()}-abc"  # of a process that lives
    other.mkdir()
    cached(tmp_path / "kept", lambda part: None)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(("kept", other.name))


@pytest.mark.parametrize(
    "damage",
    [
        lambda kept: (kept / "bin" / "program").unlink(),
        lambda kept: (kept / "bin" / "program").write_bytes(b"half"),
        lambda kept: (kept / "bin" / "program").chmod(0o600),
        lambda kept: (kept / "library").write_text(""),
        lambda kept: (kept / CONTENT).unlink(),
        lambda kept: (kept / CONTENT).write_text('{"library": '),
        lambda kept: [path.unlink() for path in (kept / "bin" / "program", kept / "library", kept / CONTENT)],
        lambda kept: (shutil.rmtree(kept), kept.write_text("a file")),
    ],
)
def test_what_is_damaged_is_made_again(tmp_path, damage):
    made = []

    def make(part):
        made.append(part)
        (part / "bin").mkdir()
        (part / "bin" / "program").write_text("whole")
        (part / "bin" / "program").chmod(0o755)
        (part / "library").write_text("whole")

    kept = cached(tmp_path / "kept", make)
    (kept / "added").write_text("later")
    cached(kept, make)
    assert len(made) == 1
    damage(kept)
    for _ in range(2):
        cached(kept, make)
    assert len(made) == 2 and [path.name for path in tmp_path.iterdir()] == ["kept"]
    assert (kept / "bin" / "program").read_text() == (kept / "library").read_text() == "whole"
