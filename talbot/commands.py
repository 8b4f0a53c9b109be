"""The open design flow for angle-sensitive-pixel sensors.

Exit status: 0 right, 1 a check fails (the chip and its golden model differ, a bound is missed, a stream is damaged),
2 bad input or environment (one line on standard error: field, value and range), 3 an error in Talbot itself (one line,
and the file that has its traceback), 130 Ctrl-C, 143 terminated.
"""

import argparse
import importlib
import os
from collections.abc import Sequence
from importlib.metadata import version
from types import ModuleType

from talbot.base.check import ONLY
from talbot.base.command import Parser, add_command, execute, guarded
from talbot.base.page import index
from talbot.base.paths import RESULTS

from .make import arguments

# name -> (module, help). A module is imported when its command is chosen.
COMMANDS = {
    "sim": ("talbot.flow.frame.command", "a scene through the golden models and the chip's Verilog"),
    "sequence": ("talbot.flow.sequence.command", "a sequence of pictures through one running simulation of the chip"),
    "lightfield": ("talbot.flow.lightfield.command", "light field and depth from a raw frame, beside free baselines"),
    "learn": ("talbot.flow.lightfield.learn.command", "the dictionary or the network of light fields, learned again"),
    "pixel": ("talbot.flow.pixel.command", "a process's pixel: gratings in its metals, solved, fitted to Eq. 3.1"),
    "cosim": ("talbot.flow.cosim.command", "a row with analog circuits: Verilog and ngspice in lock-step"),
    "pixel-layout": ("talbot.flow.pixel_layout.command", "the pixel drawn: 24 types, tile, array; design rules, LVS"),
    "pixel-circuit": ("talbot.flow.pixel_circuit.command", "the drawn pixel in ngspice: full well, noise, lag, EMVA"),
    "analog": ("talbot.flow.analog.command", "the analog circuits in ngspice: corners, mismatch, noise, datasheet"),
    "analog-layout": (
        "talbot.flow.analog_layout.command",
        "the analog circuits drawn: DRC, LVS, measured with parasitics",
    ),
    "polar": ("talbot.flow.polar.command", "polarization and highlights from a raw frame, beside free baselines"),
    "depth": ("talbot.flow.depth.command", "depth field by time of flight, unwrapped by the light field"),
    "render": ("talbot.flow.render.command", "the shipped rendered scenes again, by Mitsuba 3"),
    "calibrate": ("talbot.flow.calibrate.command", "pixel types, trims and lens from noisy frames on a bench"),
    "sensor": ("talbot.flow.sensor", "the standard sensor as a file to start from, or a file checked and completed"),
    "decode": ("talbot.flow.decode", "a byte stream of the chip back to samples (.npz)"),
    "tradeoff": ("talbot.flow.tradeoff.command", "error against run time: tables and plots"),
    "stability": ("talbot.flow.stability", "stiff and extreme cases: bound against measured"),
    "formats": ("talbot.flow.formats.command", "stream formats and scan orders compared"),
    "sizes": ("talbot.flow.sizes.command", "cells and gate equivalents of every block"),
    "divider": ("talbot.flow.simulate.divider.exhaustive", "every input of a divider through its Verilog"),
    "layout": ("talbot.flow.layout.command", "a design's Verilog to a layout with all its checks"),
    "layout-sweep": ("talbot.flow.layout.sweep.command", "layouts of variants, and of the placer's efforts"),
    "layout-energy": ("talbot.flow.layout.energy.command", "switching energy of the chip, event by event"),
    "layout-timing": ("talbot.flow.layout.measure_cells", "the cells' timing that is shipped, measured again"),
    "layout-compare": ("talbot.flow.layout.report.compare", "finished layouts side by side"),
    "openroad": ("talbot.flow.openroad.command", "a design by OpenROAD: scripts, and a run"),
    "openroad-compare": ("talbot.flow.openroad.compare", "both back ends, design by design"),
    "openroad-fit": ("talbot.flow.openroad.fit", "Tiny Tapeout projects against the room in their tiles"),
    "verilog": ("talbot.rtl.export", "the chip and its blocks as Verilog, linted"),
    "replay": ("talbot.rtl.replay.command", "a block's ports recorded in its tests, replayed into any Verilog of it"),
    "document": ("talbot.flow.host.document.command", "the documents for a host: register map, pins, tile, C header"),
    "site": ("talbot.site.command", "the documents site: READMEs, docs, API, architecture, gallery"),
    "footprints": ("talbot.pixels.footprints", "footprints of the analog blocks: LEF and GDS"),
    "cells": ("talbot.cells.command", "a cell library characterized at one corner or several"),
    "cells-report": ("talbot.cells.report.command", "the characterizer against a foundry's tables"),
    "cells-stability": ("talbot.cells.stability", "stiff and extreme cases of the characterizer"),
    "cells-compact": ("talbot.cells.compact.command", "the library Compact drawn and checked"),
    "cells-compact-area": ("talbot.cells.compact.area", "our blocks on Compact and on sky130_fd_sc_hd"),
    "cells-compact-search": ("talbot.cells.compact.search", "narrower cells of Compact by a longer search"),
    "formal": ("talbot.verif.formal.command", "every property proven, and that each catches its broken twin"),
    "coverage": ("talbot.verif.coverage.command", "line, toggle, branch, state machines and test plans"),
    "mutate": ("talbot.verif.mutation.command", "bugs planted in the RTL, each of which a test must find"),
    "fuzz": ("talbot.verif.fuzz.command", "a million inputs for the decoder and the host"),
    "bench": ("talbot.verif.bench.command", "cocotb benches in Icarus and in Verilator"),
    "stuck-at": (
        "talbot.verif.stuck_at.command",
        "stuck-at faults of the chip's gates that a test at its pins detects",
    ),
    "suite": ("talbot.verif.suite.command", "every test, counted by block and level"),
    "verify": ("talbot.verif.report.command", "all of these six, and their report"),
    "index": ("talbot.base.page.command", "the page over all results; every command brings it up to date, too"),
    "handoff": ("talbot.flow.handoff.command", "one archive of a finished layout"),
}


def parser(chosen: str = "") -> Parser:
    """The parser of all commands, with the arguments of ``chosen`` alone."""
    top = Parser(prog="talbot", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    top.add_argument("--version", action="version", version=f"%(prog)s {version('talbot')}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, (_, text) in COMMANDS.items():
        sub = commands.add_parser(name, help=text)
        if name == chosen:
            add_command(sub, command(name))
    return top


def command(name: str) -> ModuleType:
    """The module of a command, imported now."""
    return importlib.import_module(COMMANDS[name][0])


def main(argv: Sequence[str]) -> int:
    """Run the command of ``argv``; returns the exit status. '--make', from the Makefile, is for `talbot.make`."""
    words = list(argv)
    Parser.of_make = words[:1] == ["--make"]
    if Parser.of_make:
        _, given, name, *fixed = words
        alone = Parser(prog=f"talbot {name}")
        add_command(alone, command(name))
        words = [name, *arguments(alone, given, fixed)]
    status = execute(parser(words[0] if words else ""), words)
    if status not in (0, 1) or os.environ.get(ONLY):
        return status
    return guarded("talbot", lambda: refreshed(status))


def refreshed(status: int) -> int:
    """Bring the page over all results up to date; returns ``status``."""
    index.refresh(RESULTS)
    return status
