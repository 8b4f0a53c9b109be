"""Functions of a frame's end that another process compiles: the first frame finds them in Numba's cache."""

import os
import subprocess
import sys

from talbot.base.tools import ToolError
from talbot.imaging.frame import ahead

# Prints the kinds of arguments for which each function is compiled: after the process's work, and after a frame
FRAME = """
from talbot.imaging.frame import ahead
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.request import request
from talbot.models.afe import search
from talbot.models.digital.stream import payload
from talbot.models.reconstruct import edges

used = search.search, payload.encode_rows, payload.decode_rows, edges._gather, edges._scatter
ahead.main()
print([function.compiled.signatures for function in used])
golden_result(request(scene="coins", rows=24, cols=36, views=3)).rebuilt
print([function.compiled.signatures for function in used])
"""


def test_a_frame_compiles_nothing_of_them_again():
    done = subprocess.run([sys.executable, "-c", FRAME], check=True, capture_output=True, text=True)
    first, then = done.stdout.splitlines()
    assert first == then and "[]" not in first


def test_a_process_runs_for_new_functions_alone_and_may_fail(tmp_path, monkeypatch):
    started = []
    monkeypatch.setattr(ahead, "BUILD", tmp_path)
    monkeypatch.setattr(ahead, "run", started.append)
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    ahead.compiled()
    assert not started
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    ahead.compiled()
    ahead.compiled()
    assert started == [[sys.executable, "-m", "talbot.imaging.frame.ahead"]]

    def fail(words):
        raise ToolError("no memory")

    monkeypatch.setattr(ahead, "BUILD", tmp_path / "other")
    monkeypatch.setattr(ahead, "run", fail)
    ahead.compiled()
