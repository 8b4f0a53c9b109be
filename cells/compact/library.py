"""The library: every cell of the catalogue, drawn and cached, and as PDKMaster's objects for its exporters."""

from pathlib import Path
from typing import TYPE_CHECKING

from talbot.base.jobs import Job, run
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.catalogue import HIGH, named, schematics
from talbot.cells.compact.draw import Drawn, threshold
from talbot.cells.compact.make import make, recipe
from talbot.cells.compact.ties import diode, ties
from talbot.cells.compact.transistors import Schematic
from talbot.platforms.twins import TWIN

if TYPE_CHECKING:
    from pdkmaster.design.library import RoutingGaugeLibrary

NAME = "StdCellLib"
FOLDER = Path("build/cells/compact")


def drawn(
    canvas: Canvas | None = None, store: Path = FOLDER / "drawn", workers: int = -1
) -> dict[str, tuple[Schematic, Drawn]]:
    """Draw every cell; ``store`` caches the results. workers: processes, -1 for all cores."""
    canvas, cells = canvas or Canvas(), schematics()
    order = sorted(cells, key=lambda name: -len(cells[name].n))  # the widest take longest
    arguments = {name: (cells[name], canvas, recipe(name)) for name in order}
    jobs = [Job(name, make, inputs, inputs) for name, inputs in arguments.items()]
    drawings = dict(zip(order, run(jobs, store, "cells drawn", workers), strict=True))
    plain = {name: (cells[name], drawings[name]) for name in cells}
    return plain | dict(twin(*plain[name], canvas) for name in HIGH) | ties(canvas) | diode(canvas)


def twin(schematic: Schematic, drawing: Drawn, canvas: Canvas) -> tuple[str, tuple[Schematic, Drawn]]:
    """Return the twin of a cell with high-threshold p transistors, by its name: the same shapes, and one implant."""
    shapes = [*drawing["shapes"], threshold(canvas, drawing["width"])]
    name = f"{schematic.name}{TWIN}"
    return name, (named(name), {**drawing, "shapes": shapes})


def library(canvas: Canvas | None = None, store: Path = FOLDER / "drawn", workers: int = -1) -> "RoutingGaugeLibrary":
    """All cells as a library of PDKMaster, for the exporters to KLayout and SPICE.

    workers: see `drawn`; 1 in a process that should end by itself (joblib's workers keep it waiting for minutes).
    """
    from talbot.cells.compact.pdk import to_pdkmaster

    canvas = canvas or Canvas()
    return to_pdkmaster(NAME, canvas, drawn(canvas, store, workers))


def schematic_spice(schematic: Schematic, canvas: Canvas) -> str:
    """The netlist of the transistors alone, sizes in um as SkyWater's models expect them."""
    lines = [f".subckt {schematic.name} {' '.join(schematic.ports)}"]
    for kind, switches, (low, high), bulk in (("n", schematic.n, canvas.n, "vss"), ("p", schematic.p, canvas.p, "vdd")):
        model = f"sky130_fd_pr__{schematic.models[kind]} w={high - low:.4g} l={canvas.length:.4g}"
        lines += [f"X{kind}{k} {s.a} {s.gate} {s.b} {bulk} {model}" for k, s in enumerate(switches)]
    return "\n".join([*lines, ".ends", ""])
