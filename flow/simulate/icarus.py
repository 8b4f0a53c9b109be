"""The same frame bench in Icarus: event-driven and 4-state, for small frames."""

from pathlib import Path

from .process import run
from .verilator import FRAME, ROOT, export_verilog


def icarus_program(build, folder):
    """Compile the bench for ``build`` into ``folder``; returns the program's path. Raises ToolError."""
    folder = Path(folder)
    chip = export_verilog(build, folder)
    program = folder / "bench.vvp"
    geometry = [f"-PClock.{name}={value}" for name, value in (
        ("ROWS", build.rows), ("COLS", build.cols), ("LANES", build.lanes),
        ("TILE_ROWS", build.tile_rows), ("TILE_COLS", build.tile_cols), ("TAPS", build.taps))]
    run(["iverilog", "-g2012", "-s", "Clock", *geometry, "-o", program, chip, ROOT / "pixels" / "afe.sv",
         FRAME / "bench.sv", FRAME / "clock.sv"])
    return program
