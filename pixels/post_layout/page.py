"""The page of the drawn analog circuits: pictures, checks, layout and schematic."""

import io
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from PIL import Image

from talbot.base import page
from talbot.base.charts import save
from talbot.base.gds import read_gds
from talbot.base.page import TABLES, Picture, Section, Tile
from talbot.pixels.pixel_layout.pictures import ACTIVE, METALS, POLY, WELL, draw_masks
from talbot.platforms.pixel import PixelProcess

PICTURES = {
    "comparator": (
        "The comparator",
        "Below the strong-arm latch, symmetric about its middle: the input pair outside, with dummies at its ends; "
        "above the latch that holds the decision. The outputs change tracks on the axis.",
    ),
    "sar_lane": (
        "The lane",
        "From the south drivers, switches, the DAC's capacitors, the comparator, the other side's "
        "capacitors, their switches.",
    ),
    "row": (
        "A row's driver",
        "On the pixels' pitch: decoders, gates and the latch in the west, six level shifters under thick oxide in the "
        "east, and the lines at their places.",
    ),
    "column": (
        "A column, lying",
        "On the pixels' pitch: in the west the feedback of both charge amplifiers and their strip, their coupling "
        "capacitors, the strip of both second stages, then each tap of the first diode with its capacitor.",
    ),
    "non_overlap": ("The switch drivers", "Two loops of a gate and its delays about the inverter between them."),
    "amplifier": (
        "The amplifier",
        "From the south the bank of one input, half of the pair over half of the sinks, the tail's parts, the other "
        "half, mirror and switches, the bank of the other input, the trim's switches.",
    ),
    "bias": ("The bias", "A pair of one to 16 about its middle, two halves of each output, the resistor below."),
    "adc_lanes": ("All lanes in the die's frame", "Below them the channel to the chip's pins, above the references."),
}
NAMES = ("analog_layout.html", *(f"{name}.png" for name in PICTURES))


def write(folder: Path, s: dict[str, Any], process: PixelProcess) -> None:
    """Write the page and its pictures next to the files of the cells in ``folder``."""
    pictures = []
    for name, about in PICTURES.items():
        path = folder / f"{name}.png"
        save(picture(folder / f"{name}.gds", process), path)
        pictures.append(Picture(name, *about, Image.open(io.BytesIO(path.read_bytes()))))
    cells = s["cells"]
    broken, same = sum(sum(one["drc"].values()) for one in cells.values()), all(c["lvs_match"] for c in cells.values())
    failed = sum(not row["passes"] for row in s["rows"])
    text = page.render(
        TABLES,
        f"{s['process']}: the analog circuits drawn",
        picture=pictures[0].image,
        about="comparator, capacitor arrays, lane, amplifier, bias; make analog-layout",
        tiles=[
            Tile(str(broken), "violations of design rules", "bad" if broken else "good"),
            Tile("matches" if same else "differs", "layout against circuit", "good" if same else "bad"),
            Tile(str(failed), "figures of the layout outside their limits", "bad" if failed else "good"),
        ],
        sections=[
            *(Section(one.title, pictures=[one]) for one in pictures),
            Section(
                "Layout and schematic",
                "The same measurements of the circuit alone and of the extracted layout: drawn junctions, resistance "
                "and capacitance of all nets. The DAC's levels also from the capacitances alone, all 256.",
                head=("characteristic", "unit", "schematic", "layout", "limit", "", "corner"),
                rows=[_row(row) for row in s["rows"]],
                numbers=False,
            ),
            Section(
                "Cells",
                head=("cell", "um x um", "transistors", "violations", "LVS", "parasitic capacitors", "resistors"),
                rows=[_cell(name, one) for name, one in cells.items()],
            ),
            Section(
                "Nets of the comparator",
                "fF of each in the layout, all couplings in it.",
                head=("net", "fF"),
                rows=[(net, f"{value:.2f}") for net, value in cells["comparator"]["net_fF"].items()],
            ),
        ],
    )
    (folder / "analog_layout.html").write_text(text, encoding="utf-8")


def picture(gds: Path, process: PixelProcess) -> Figure:
    """All masks of a cell over one another."""
    layout = read_gds(gds)
    box = layout.top_cell().dbbox()
    wide = box.width() > box.height()
    figure = Figure(figsize=(11, 11 * box.height() / box.width()) if wide else (5, 5 * box.height() / box.width()))
    shown = [(process.well, WELL), (process.active, ACTIVE), (process.tap, ACTIVE), (process.poly, POLY)]
    shown += [(metal.gds, METALS[k]) for k, metal in enumerate(process.metals[:5])]
    draw_masks(figure.subplots(), gds, shown, "", (box.left, box.bottom, box.right, box.top))
    return figure


def _row(row: dict[str, Any]) -> tuple[str, ...]:
    limit = "" if row["most"] is None else f"<= {row['most']:.3g}"
    limit = limit if row["least"] is None else f">= {row['least']:.3g}"
    verdict = "" if not limit else "pass" if row["passes"] else "FAIL"
    return row["name"], row["unit"], f"{row['schematic']:.3g}", f"{row['layout']:.3g}", limit, verdict, row["corner"]


def _cell(name: str, one: dict[str, Any]) -> tuple[str, ...]:
    size = f"{one['width_um']:.2f} x {one['height_um']:.2f}"
    verdict = "matches" if one["lvs_match"] else "DIFFERS"
    counts = (str(one.get(key, "")) for key in ("capacitors", "resistors"))
    return name, size, str(one["transistors"]), str(sum(one["drc"].values())), verdict, *counts
