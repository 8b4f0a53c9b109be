"""The commands in groups, a line each: what `talbot --help` and `make help` show.

`make help` runs this file before anything is installed: it imports the standard library alone.
"""

from typing import NamedTuple

WIDTH = 100  # characters of a line


class Command(NamedTuple):
    """A command of the program, or a target that only make has.

    summary: a line for people. module: below `talbot`, imported when the command is chosen; "" for a target of make
    alone. target: whether make has a target of this name.
    """

    summary: str
    module: str = ""
    target: bool = True


GROUPS: dict[str, dict[str, Command]] = {
    "Start here": {
        "sim": Command("a photograph through the models and the chip's Verilog", "imaging.frame.command"),
        "sensor": Command(
            "write the default sensor as a file to edit, for SENSOR= of other commands", "imaging.sensor"
        ),
        "setup": Command("install all packages that tests need into .venv"),
        "test": Command("the fast tests of every model and block"),
    },
    "Pictures": {
        "lightfield": Command("light field, refocused pictures and depth of a frame", "imaging.lightfield.command"),
        "cameras": Command("the same scenes by lenslets, a coded mask and other cameras", "imaging.cameras.command"),
        "depth": Command("time of flight: a depth map, unwrapped by the light field", "imaging.depth.command"),
        "polar": Command("angle and degree of polarization, highlights separated", "imaging.polar.command"),
        "recognize": Command("digits or your pictures classified from the chip's bytes", "imaging.recognize.command"),
        "sequence": Command("a clip or a folder of pictures, frame after frame", "imaging.sequence.command"),
        "calibrate": Command("pixel types, offsets and lens estimated from bench frames", "imaging.calibrate.command"),
        "explore": Command("which sensor for my task: the front of error and costs", "imaging.explore.command"),
        "tradeoff": Command("error against run time: tables and plots", "imaging.tradeoff.command"),
        "stability": Command("stiff and extreme cases of all subjects: bounds and measured figures", "verif.stability"),
        "decode": Command("the chip's byte stream to samples, as .npz", "imaging.decode"),
    },
    "Pixel and analog": {
        "pixel": Command("search and solve the gratings of a pixel in a process's metal", "pixels.response.command"),
        "pixel-layout": Command(
            "layout of the 24 pixel types and the array, with DRC and LVS", "pixels.pixel_layout.command"
        ),
        "pixel-circuit": Command("the pixel in ngspice: full well, gain, noise, lag", "pixels.pixel_circuit.command"),
        "analog": Command(
            "amplifier and converter in ngspice: corners, mismatch, datasheet", "pixels.datasheet.command"
        ),
        "analog-layout": Command("their layout, with DRC, LVS and extracted parasitics", "pixels.post_layout.command"),
        "cosim": Command("a row of pixels: Verilog and ngspice in lock-step", "verif.cosim.command"),
        "footprints": Command("LEF and GDS outlines of the analog blocks", "pixels.footprints"),
    },
    "Silicon": {
        "verilog": Command("the chip and each block as SystemVerilog, with FuseSoC cores", "rtl.export"),
        "sizes": Command("cells and gate equivalents of every block", "flow.sizes.command"),
        "layout": Command("Verilog to a checked GDS: the chip, a block or the die", "flow.layout.command"),
        "openroad": Command("scripts and layout of a design by OpenROAD", "flow.openroad.command"),
        "cells": Command("characterize standard cells: transistors to Liberty and LEF", "cells.command"),
        "sram": Command("a static RAM's cell: layout, margins, a column in ngspice", "memory.command"),
        "handoff": Command("one reproducible archive of a finished layout", "flow.handoff.command"),
    },
    "Verification": {
        "verify": Command("all of the verification below, with a report", "verif.report.command"),
        "formal": Command("prove the properties of every block", "verif.formal.command"),
        "suite": Command("every test, the slow ones too, counted by block", "verif.suite.command"),
        "cocotb": Command("cocotb benches in Icarus and in Verilator", "verif.bench.command"),
        "coverage": Command("line, branch, toggle and state coverage, test plans", "verif.coverage.command"),
        "mutate": Command("bugs planted in the RTL, each of which a test must detect", "verif.mutation.command"),
        "fuzz": Command("random inputs for decoder and host, sessions at the chip's pins", "verif.fuzz.command"),
        "stuck-at": Command("stuck-at faults that a test at the chip's pins detects", "verif.stuck_at.command"),
        "replay": Command("port traces of a block's tests, replayed into other Verilog", "rtl.replay.command", False),
    },
    "Documents": {
        "index": Command("the page with links to all results: build/index.html", "base.page.command"),
        "document": Command("register map, pin tables and C header for a host", "rtl.host.document.command"),
        "site": Command("the documentation as a web site: build/site/index.html", "site.command"),
    },
    "Developers": {
        "tools": Command("install Icarus, Verilator, z3, ngspice, OpenSTA, KLayout"),
        "setup-layout": Command("install PDKs, KLayout and OpenROAD into .venv"),
        "lint": Command("ruff, import layers, types, docstrings"),
        "format": Command("format the code and apply ruff's fixes"),
        "bench": Command("benchmarks of speed and memory"),
        "locks": Command("renew requirements/*.lock from pyproject.toml"),
        "librelane": Command("LibreLane itself on our designs"),
        "dist": Command("wheel and source distribution, checked: dist/"),
        "openroad-compare": Command("layouts with both cell libraries in one table", "flow.openroad.compare"),
        "cells-report": Command("the characterizer compared with a foundry's tables", "cells.report.command"),
        "cells-compact": Command("draw and check the cell library Compact", "cells.compact.command"),
        "layout-timing": Command("measure the shipped cell timing again in ngspice", "flow.layout.measure_cells"),
        "clean": Command("delete build/ and dist/"),
    },
}
COMMANDS = {name: command for group in GROUPS.values() for name, command in group.items() if command.module}


def listing(make: bool) -> str:
    """The commands in groups, a line of at most WIDTH characters each. make: as targets, with those of make alone."""
    lines = []
    for title, group in GROUPS.items():
        shown = {name: command for name, command in group.items() if (command.target if make else command.module)}
        if shown:
            lines += ["", f"{title}:"]
        lines += [f"  {name:20} {command.summary}" for name, command in shown.items()]
    return "\n".join(lines[1:])


def main() -> None:
    """Print the text of `make help`."""
    print("make COMMAND, for example: make sim SCENE=photo.png THRESHOLD=12\n")
    print(listing(make=True))
    print("\nA command's options are variables. make COMMAND-help lists them: make sim-help")


if __name__ == "__main__":
    main()
