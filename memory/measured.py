"""Margins of an extracted cell and a column over corners: jobs whose results are kept."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from talbot.base.jobs import Job, run
from talbot.cells.corner import PROCESSES, Corner
from talbot.memory import access, margins
from talbot.memory.access import Access
from talbot.memory.margins import KINDS, Margins
from talbot.memory.parameters import SramParameters

TYPICAL = tuple(Corner(process, 25, 1.8).name for process in PROCESSES)
ENDS = tuple(Corner(*corner).name for corner in product(("sf", "fs"), (-40, 125), (1.62, 1.98)))
COLUMN = "tt_025C_1v80", "ss_100C_1v60", "ff_n40C_1v95", "sf_025C_1v80", "fs_025C_1v80"
BATCH = 25  # cells of a deck


@dataclass(frozen=True)
class Spread:
    """Of cells with mismatch, V. mean, sigma, least: of their margins."""

    corner: str
    cells: int
    mean: float
    sigma: float
    least: float


def nominal(netlist: str, corners: Sequence[str], store: Path, workers: int) -> dict[str, Margins]:
    """Return the margins of a cell without mismatch by corner."""
    jobs = [Job(corner, margins.nominal, (netlist, corner), (netlist, corner)) for corner in corners]
    results = run(jobs, store, "corners", workers)
    return {corner: Margins(**margin) for corner, margin in zip(corners, results, strict=True)}


def accesses(sram: SramParameters, netlist: str, store: Path, workers: int) -> dict[str, Access]:
    """Return what a column does at the corners of COLUMN."""
    jobs = [
        Job(f"column_{corner}", access.measure, (sram, netlist, corner), (sram, netlist, corner)) for corner in COLUMN
    ]
    results = run(jobs, store, "corners of a column", workers)
    return {corner: Access(**measured) for corner, measured in zip(COLUMN, results, strict=True)}


def spreads(netlist: str, typical: dict[str, Margins], draws: int, store: Path, workers: int) -> dict[str, Spread]:
    """Return the spread of each margin of KINDS, where ``typical``, without mismatch, has the least."""
    worst = {kind: min(typical, key=lambda corner, kind=kind: getattr(typical[corner], kind)) for kind in KINDS}
    starts = range(0, draws, BATCH)
    cases = [(kind, worst[kind], min(BATCH, draws - start), 1 + start) for kind in KINDS for start in starts]
    jobs = [
        Job(f"{kind}_{seed}", margins.spread, (netlist, *case), (netlist, *case))
        for case in cases
        for kind, _, _, seed in [case]
    ]
    results = run(jobs, store, "batches of cells", workers)
    out = {}
    for kind, corner in worst.items():
        values = np.concatenate([batch for batch, case in zip(results, cases, strict=True) if case[0] == kind])
        out[kind] = Spread(corner, len(values), *(float(f(values)) for f in (np.mean, np.std, np.min)))
    return out
