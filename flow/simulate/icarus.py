"""The same frame bench in Icarus: event-driven and 4-state, for small frames."""

from pathlib import Path

from base.tools import run

from .verilator import FRAME, ROOT, export_verilog


def icarus_program(build, folder, chip=None, tops=()):
    """Compile the bench for ``build`` into ``folder``; returns the program's path. Raises ToolError.

    chip: Verilog files of it, a netlist's and its cells' too; exported now if None. tops: modules beside the bench.
    """
    folder = Path(folder)
    chip = chip or [export_verilog(build, folder)]
    program = folder / "bench.vvp"
    geometry = [
        f"-PClock.{name}={value}"
        for name, value in (
            ("ROWS", build.rows),
            ("COLS", build.cols),
            ("LANES", build.lanes),
            ("TILE_ROWS", build.tile_rows),
            ("TILE_COLS", build.tile_cols),
            ("TAPS", build.taps),
        )
    ]
    run(
        [
            "iverilog",
            "-g2012",
            *(part for top in ("Clock", *tops) for part in ("-s", top)),
            *geometry,
            "-o",
            program,
            *chip,
            ROOT / "pixels" / "afe.sv",
            FRAME / "bench.sv",
            FRAME / "clock.sv",
        ]
    )
    return program
