"""The same frame bench in Icarus: event-driven and 4-state, for small frames."""

import shutil
import subprocess
from pathlib import Path

from .verilator import FRAME, ROOT, ToolError, export_verilog


def icarus_program(build, folder):
    """Compile the bench for ``build`` into ``folder``; returns the program's path. Raises ToolError."""
    if not shutil.which("iverilog"):
        raise ToolError("iverilog: not found; install it with: make tools (Debian: apt-get install iverilog)")
    folder = Path(folder)
    chip = export_verilog(build, folder)
    program = folder / "bench.vvp"
    geometry = [f"-PClock.{name}={value}" for name, value in (
        ("ROWS", build.rows), ("COLS", build.cols), ("LANES", build.lanes),
        ("TILE_ROWS", build.tile_rows), ("TILE_COLS", build.tile_cols), ("TAPS", build.taps))]
    result = subprocess.run(["iverilog", "-g2012", "-s", "Clock", *geometry, "-o", program, chip,
                             ROOT / "pixels" / "afe.sv", FRAME / "bench.sv", FRAME / "clock.sv"],
                            capture_output=True, text=True)
    if result.returncode:
        raise ToolError(f"iverilog failed with status {result.returncode}:\n{result.stderr[-800:]}")
    return program
