"""The library: every cell of the catalogue made once and kept, and as PDKMaster's objects for its exporters."""

from pathlib import Path

from cells.flexcell.canvas import Canvas
from cells.flexcell.catalogue import schematics
from cells.flexcell.make import make
from cells.flexcell.ties import diode, ties
from flow.jobs import Job, run

NAME = "StdCellLib"
STORE = Path("build/cells/flexcell/drawn")
SOURCES = [Path(__file__).with_name(f"{part}.py") for part in
           ("transistors", "place", "grid", "route", "assemble", "draw", "rules", "make")]


def drawn(canvas=None, store=STORE, workers=-1, names=None):
    """name -> (Schematic, drawing: dict with width in um and shapes) of every cell, or of ``names``.

    Made by `flow.jobs` and kept in ``store``: a second call reads them.
    """
    canvas = canvas or Canvas()
    wanted = {name: s for name, s in schematics().items() if names is None or name in names}
    order = sorted(wanted, key=lambda name: -len(wanted[name].n))            # the widest take longest
    jobs = [Job(name, make, (wanted[name], canvas), (wanted[name], canvas, *SOURCES)) for name in order]
    made = dict(zip(order, run(jobs, store, "cells drawn", workers), strict=True))
    return {name: (wanted[name], made[name]) for name in wanted} | {
        name: entry for name, entry in (ties(canvas) | diode(canvas)).items() if names is None or name in names}


def library(canvas=None, store=STORE):
    """pdkmaster.design.library.RoutingGaugeLibrary of all cells, for the exporters to Coriolis, KLayout and SPICE."""
    from cells.flexcell.pdk import to_pdkmaster

    canvas = canvas or Canvas()
    return to_pdkmaster(NAME, canvas, drawn(canvas, store))
