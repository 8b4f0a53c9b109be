"""A call in a separate process ends when its work is done."""

import subprocess
import sys
import time

import pytest

from talbot.base.jobs import Job, run
from talbot.base.steps.alone import _end_with_parent, alone

PARENT = """
import multiprocessing, os
from talbot.base.steps.test.alone_test import stays
child = multiprocessing.get_context("spawn").Process(target=stays, args=({platform!r},))
child.start()
while not input() == "end": pass
os._exit(0)
"""


def wide(folder):
    return sum(run([Job(f"n{n}", int, (n,)) for n in range(3)], folder, "numbers", workers=2))


@pytest.mark.timeout(200)  # joblib's workers stay for 300 s
def test_what_went_wide_does_not_wait_for_idle_workers(tmp_path):
    assert alone(wide, tmp_path / "store")[0] == 3


def stays(platform):
    sys.platform = platform
    _end_with_parent()
    print("begun", flush=True)
    time.sleep(500)


@pytest.mark.parametrize("platform", ["linux", "darwin"])
def test_a_process_ends_with_its_parent(platform):
    """Its output, which it shares with its parent, ends when both have."""
    with subprocess.Popen(
        [sys.executable, "-c", PARENT.format(platform=platform)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        encoding="utf-8",
    ) as parent:
        assert parent.stdout.readline() == "begun\n"
        assert parent.communicate("end\n", timeout=200)[0] == ""
