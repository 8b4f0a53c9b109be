"""Pixels, tile and array: drawn, written, checked -> GDS, LEF, SPICE, pictures, page, summary.json."""

import json
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from talbot.base.files import check_file, check_folder, staged, write
from talbot.base.gds import db, write_gds
from talbot.models.parameters import PixelType, SensorParameters
from talbot.pixels.designs import gratings
from talbot.pixels.drawn import PIXEL_PITCHES_UM
from talbot.pixels.layout.array import DUMMIES, SOUTH, WEST, draw_array, draw_pixels, draw_tile
from talbot.pixels.layout.circuit import Diode, spice, spice_array
from talbot.pixels.layout.pixel import PixelLayout
from talbot.pixels.layout.write import array_layout, array_lef, fitted
from talbot.pixels.pixel_layout import foundry
from talbot.pixels.pixel_layout.checks import WAIVERS, densities, drc, lvs, placed, unwaived
from talbot.pixels.pixel_layout.curves import at_heights, curves, kept
from talbot.pixels.pixel_layout.curves import table as curve_table
from talbot.pixels.pixel_layout.lines import extracted
from talbot.pixels.pixel_layout.lines import table as line_table
from talbot.pixels.pixel_layout.made import SMALL, Made
from talbot.pixels.response.types import name_of
from talbot.platforms.foundry import installed
from talbot.platforms.optics import optical_stack

STEPS = "optics", "draw", "count", "drc", "foundry", "lvs", "lines", "curves", "report"
FILES = "pixel_array.gds", "pixel_array.lef", "tile.gds", "pixel.gds", "small_array.gds", "pixel.spice", "summary.json"
REPORTS = "drc.lyrdb", "pixel.lvsdb", "tile.lvsdb", "small_array.lvsdb", *foundry.REPORTS
MOST_SECONDS, MOST_BYTES = 30.0, 20e6  # of the array's GDS


def make(
    pdk: str,
    sensor: SensorParameters,
    out: Path,
    table: Path | None = None,
    responses: Path | None = None,
    heights: str | None = None,
    note: Callable[[str], None] = lambda text: None,
) -> dict[str, Any]:
    """Draw, check and report into ``out``, the lines into ``table``, curves into ``responses``; returns the summary.

    heights: the table of heights of the curves, None: the process's first.
    Raises ParameterError, StepError.
    """
    from talbot.pixels.pixel_layout import page  # Matplotlib: not before it is needed

    start = perf_counter()
    check_folder("out", out)
    for name, file in (("table", table), ("curves", responses)):
        if file:
            check_file(name, file)
    optical_stack(pdk, heights)
    decks = installed(pdk)
    rows, cols = sensor.shape
    array = array_layout(pdk, rows, cols, sensor.tile, sensor.array.pitch)
    small = replace(array, array=replace(array.array, rows=SMALL[0], cols=SMALL[1]))
    types = [_type(pixel, gratings(pdk).wavelength_um) for pixel in array.pixels]
    with staged(out, (*FILES, *REPORTS, *page.NAMES)) as folder:
        made = Made(array, small, folder)
        note("draw")
        seconds = _draw(made)
        note("count")
        wrong = _misplaced(made)
        note("drc")
        found = drc(made.path("small_array.gds"), pdk, made.path("drc.lyrdb"))
        note("foundry")
        theirs = foundry.check(array, pdk, folder, decks)
        note("lvs")
        same = {
            name: lvs(made.path(f"{name}.gds"), text, pdk, made.path(f"{name}.lvsdb")) for name, text in _spice(made)
        }
        note("lines")
        lines = extracted(array)
        note("curves")
        solved = curves(at_heights(array.pixels, heights), gratings(pdk).wavelength_um)
        share, most = densities(made.path("tile.gds"), pdk), array.pixels[0].process.density_most
        block, size = array.block, made.path("pixel_array.gds").stat().st_size
        summary = {
            "process": pdk,
            "rows": rows,
            "cols": cols,
            "pitch_um": array.pitch_um,
            "tile": [sensor.tile.rows, sensor.tile.cols],
            "width_um": block.width_um,
            "height_um": block.height_um,
            "pixels": (rows + 2 * DUMMIES) * (cols + 2 * DUMMIES),
            "misplaced": wrong,
            "gds_bytes": size,
            "gds_s": seconds,
            "fill_factor": array.pixels[0].fill_factor,
            "types": types,
            "drc": found,
            "drc_violations": unwaived(found),
            "waivers": {rule: {"count": found[rule], "reason": WAIVERS[rule]} for rule in found if rule in WAIVERS},
            "foundry": theirs,
            "lines": {name: asdict(line) for name, line in lines.items()},
            "heights": optical_stack(pdk, heights).heights,
            "curves": solved,
            "response": {_name(curve): asdict(kept(curve)) for curve in solved},
            "density": share,
            "density_most": most,
            "lvs_match": same,
            "passed": not (wrong or unwaived(found) or foundry.total(theirs) or max(share.values()) > most)
            and all(same.values())
            and seconds < MOST_SECONDS
            and size < MOST_BYTES,
            "wall_s": perf_counter() - start,
        }
        note("report")
        page.write(made, summary)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if table:
        by_pitch = {
            um: lines if um == array.pitch_um else extracted(array_layout(pdk, rows, cols, sensor.tile, 1e-6 * um))
            for um in PIXEL_PITCHES_UM
        }
        write(table, json.dumps(line_table(pdk, by_pitch), indent=1, allow_nan=False) + "\n")
    if responses:
        write(
            responses,
            json.dumps(curve_table(pdk, gratings(pdk).wavelength_um, solved, heights), allow_nan=False) + "\n",
        )
    return summary


def _name(curve: dict[str, Any]) -> str:
    return name_of(PixelType(curve["beta"], curve["gamma_deg"], curve["alpha"]))


def _draw(made: Made) -> float:
    """Write all layouts and the LEF; returns the seconds that the array took."""
    layout = db.Layout()
    layout.dbu = 0.001
    cells = draw_pixels(layout, made.small)
    write_gds(layout, made.path("tile.gds"), draw_tile(layout, made.small, cells))
    shown = made.array.pixels.index(made.shown)
    write_gds(layout, made.path("pixel.gds"), cells[shown])
    write_gds(layout, made.path("small_array.gds"), draw_array(layout, made.small, cells))
    start = perf_counter()
    layout = db.Layout()
    layout.dbu = 0.001
    top = draw_array(layout, made.array, draw_pixels(layout, made.array))
    write_gds(layout, made.path("pixel_array.gds"), top)
    seconds = perf_counter() - start
    made.path("pixel_array.lef").write_text(array_lef(made.array), encoding="utf-8")
    return seconds


def _misplaced(made: Made) -> int:
    """Pixels of the array's file that are not of the type that the sensor has there, and those that are missing."""
    array, tile = made.array.array, made.array.tile
    found = placed(made.path("pixel_array.gds"))
    pitch = made.array.pitch_um
    types = tile.type_map(array.rows, array.cols)
    right = 0
    for (row, col), number in np.ndenumerate(types):
        x = WEST + (col + DUMMIES) * pitch
        y = SOUTH + (array.rows - 1 - row + DUMMIES) * pitch
        right += found.get((round(1000 * x), round(1000 * y))) == made.array.pixels[number].name
    dummies = (array.rows + 2 * DUMMIES) * (array.cols + 2 * DUMMIES) - types.size
    return types.size - right + abs(len(found) - types.size - dummies)


def _spice(made: Made) -> list[tuple[str, str]]:
    """(file, circuit) of what is compared."""
    process, pixel = made.array.pixels[0].process, made.shown
    names = process.deck_model, process.deck_diode
    ring, tile = Diode("ring", "vdda", *made.small.well_ring_um), made.array.tile
    one = spice("pixel", pixel.circuit, *names)
    made.path("pixel.spice").write_text(one, encoding="utf-8")
    return [
        ("pixel", spice(pixel.name, pixel.circuit, *names)),
        ("tile", one + spice_array("tile", "pixel", tile.rows, tile.cols, 0, None, process.deck_diode)),
        ("small_array", one + spice_array("pixel_array", "pixel", *SMALL, DUMMIES, ring, process.deck_diode)),
    ]


def _type(pixel: PixelLayout, wavelength_um: float) -> dict[str, Any]:
    """Return the drawn dimensions of a type, the solved ones, and the response of the drawn gratings."""
    upper, lower = pixel.gratings()
    solved, drawn = fitted(pixel.geometry, wavelength_um), fitted(pixel.drawn, wavelength_um)
    return {
        "name": name_of(pixel.kind),
        "cell": pixel.name,
        "direction": upper.direction,
        "off_deg": float(np.rad2deg(upper.off)),
        "period_um": [pixel.geometry.period_um, pixel.drawn.period_um],
        "fill": [pixel.geometry.fill, upper.fill],
        "analyzer_fill": [pixel.geometry.analyzer_fill, lower.fill],
        "beta": [solved.beta, drawn.beta],
        "m": [solved.m, drawn.m],
        "quantum_efficiency": [solved.quantum_efficiency, drawn.quantum_efficiency],
    }
