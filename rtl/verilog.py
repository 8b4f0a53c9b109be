"""Verilog of the chip and its blocks, translated in a separate process."""

import sys
from collections.abc import Sequence
from pathlib import Path

from talbot.base.paths import ROOT
from talbot.base.tools import run


def export_verilog(folder: Path, tops: Sequence[str] = (), options: Sequence[object] = ()) -> list[Path]:
    """Write <top>.sv of each of ``tops`` (default: all) into ``folder``; returns the files.

    options: of the sensor, see `rtl.export`. Raises ToolError.
    """
    words = [sys.executable, "-m", "talbot.rtl.export", "--out", folder.absolute(), *(f"--top={top}" for top in tops)]
    words += options
    return [Path(line) for line in run(words, cwd=ROOT).splitlines()]
