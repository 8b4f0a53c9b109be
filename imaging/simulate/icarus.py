"""The same frame bench in Icarus: event-driven and 4-state, for small frames and netlists."""

from collections.abc import Sequence
from pathlib import Path

from talbot.base.paths import PACKAGE
from talbot.base.tools import run
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.verilator import FRAME


def icarus_program(build: Build, folder: Path, chip: Sequence[Path] = (), tops: Sequence[str] = ()) -> Path:
    """Compile the bench for ``build`` into ``folder``; returns the program's path. Raises ToolError.

    chip: Verilog files of it, a netlist's and its cells' too; exported now if empty. tops: modules next to the bench.
    """
    program = folder / "bench.vvp"
    bench = [PACKAGE / "pixels" / "afe.sv", FRAME / "bench.sv", FRAME / "clock.sv"]
    sources = [*(chip or [build.chip_verilog(folder)]), *bench]
    roots = [word for top in ("Clock", *tops) for word in ("-s", top)]
    run(["iverilog", "-g2012", *roots, *build.parameters("-PClock."), "-o", program, *sources])
    return program
