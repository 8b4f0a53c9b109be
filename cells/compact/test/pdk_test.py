import subprocess
import sys

import pytest

PROGRAM = "import asyncio, gc; import talbot.cells.compact.pdk; asyncio.set_event_loop(None); gc.collect()"


@pytest.mark.needs("layout")
def test_the_process_leaves_no_event_loop_open():
    """It draws cells when it is imported; the collector would find their loop during any other test."""
    program = [sys.executable, "-W", "always::ResourceWarning", "-c", PROGRAM]
    got = subprocess.run(program, capture_output=True, text=True, timeout=300, check=True)
    assert "unclosed" not in got.stderr
