"""Time of whole commands, as a user waits for them: first with nothing kept, then again (make bench)."""

import os
import subprocess
import sys
from time import perf_counter

import pytest


@pytest.mark.parametrize("command", ["sim", "lightfield", "calibrate"])
def test_command(benchmark, tmp_path, command):
    """extra_info: seconds of the first run, and how many of the others one such takes."""
    environment = os.environ | {"TALBOT_BUILD": str(tmp_path / "build")}

    def run():
        words = [sys.executable, "-m", "talbot", command, f"--out={tmp_path / 'out'}"]
        subprocess.run(words, env=environment, check=True, capture_output=True)

    start = perf_counter()
    run()
    first = perf_counter() - start
    benchmark.pedantic(run, rounds=1 if command == "calibrate" else 3)
    benchmark.extra_info.update(first_s=first, first_over_again=first / benchmark.stats.stats.min)
    print(f"\n{command}: first {first:.1f} s, again {benchmark.stats.stats.min:.1f} s")
