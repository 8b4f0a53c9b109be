"""The library: every cell of the catalogue made once and kept, and as PDKMaster's objects for its exporters."""

from pathlib import Path

from base.jobs import Job, run
from cells.compact.canvas import Canvas
from cells.compact.catalogue import schematics
from cells.compact.make import make, recipe
from cells.compact.ties import diode, ties

NAME = "StdCellLib"
FOLDER = Path("build/cells/compact")


def drawn(canvas=None, store=FOLDER / "drawn", workers=-1, names=None):
    """name -> (Schematic, drawing: dict with width in um and shapes) of every cell, or of ``names``.

    Made by `base.jobs` and kept in ``store``: a second call reads them.
    """
    canvas = canvas or Canvas()
    wanted = {name: s for name, s in schematics().items() if names is None or name in names}
    order = sorted(wanted, key=lambda name: -len(wanted[name].n))  # the widest take longest
    jobs = [
        Job(name, make, (wanted[name], canvas, known := recipe(name)), (wanted[name], canvas, known)) for name in order
    ]
    made = dict(zip(order, run(jobs, store, "cells drawn", workers), strict=True))
    return {name: (wanted[name], made[name]) for name in wanted} | {
        name: entry for name, entry in (ties(canvas) | diode(canvas)).items() if names is None or name in names
    }


def library(canvas=None, store=FOLDER / "drawn", workers=-1):
    """pdkmaster.design.library.RoutingGaugeLibrary of all cells, for the exporters to Coriolis, KLayout and SPICE.

    workers: processes that draw what is not in ``store``; 1 within a process that should end by itself (joblib's
    workers keep it waiting for five minutes).
    """
    from cells.compact.pdk import to_pdkmaster

    canvas = canvas or Canvas()
    return to_pdkmaster(NAME, canvas, drawn(canvas, store, workers))


def schematic_spice(schematic, canvas):
    """The transistors alone, in um, as SkyWater's models want them."""
    lines = [f".subckt {schematic.name} {' '.join(schematic.ports)}"]
    for kind, switches, (low, high), bulk in (("n", schematic.n, canvas.n, "vss"), ("p", schematic.p, canvas.p, "vdd")):
        lines += [
            f"X{kind}{k} {s.a} {s.gate} {s.b} {bulk} sky130_fd_pr__{kind}fet_01v8 w={high - low:.4g} "
            f"l={canvas.length:.4g}"
            for k, s in enumerate(switches)
        ]
    return "\n".join([*lines, ".ends", ""])
