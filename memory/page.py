"""The page of the static RAM: masks, checks, margins."""

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from PIL import Image

from talbot.base import page
from talbot.base.charts import save
from talbot.base.page import TABLES, Picture, Section, Tile
from talbot.memory.tables import tables
from talbot.pixels.pixel_layout.pictures import ACTIVE, METALS, POLY, WELL, draw_masks
from talbot.platforms.pixel import PixelProcess

PICTURES = ("bit_cell.png",)
TITLES = {
    "density": "Density",
    "margins": "Margins without mismatch",
    "mismatch": "Margins with mismatch",
    "column": "A column",
}
ABOUT = {
    "density": "OpenRAM's cell breaks the plain rules; its macro has decoders, sense amplifiers and a spare column.",
    "margins": "hold, read: static noise margin. write: voltage of the falling bit line at which the cell changes.",
    "mismatch": "At the corner where the margin is the least without mismatch.",
    "column": "One bit with the longest lines of extracted cells; its periphery is a circuit that is not drawn. "
    "difference: between the bit lines as the sense amplifier starts.",
}


def write(folder: Path, summary: dict[str, Any], process: PixelProcess) -> None:
    """Write sram.html and its picture into ``folder``, which has tile.gds."""
    path = folder / PICTURES[0]
    save(picture(folder / "tile.gds", process), path)
    shown = Picture(
        "bit_cell", "Cells", "Masks of cells next to a strap and of the circuits below their columns.", Image.open(path)
    )
    broken, same = sum(summary["drc"].values()), summary["lvs_match"]
    sections = [Section("Cells", pictures=[shown])]
    sections += [
        Section(TITLES[mark], ABOUT[mark], head=head, rows=rows) for mark, (head, rows) in tables(summary).items()
    ]
    text = page.render(
        TABLES,
        f"{summary['process']}: static RAM",
        picture=shown.image,
        about="a cell of six transistors under plain logic rules; make sram",
        tiles=[
            Tile(str(broken), "violations of design rules", "bad" if broken else "good"),
            Tile("matches" if same else "differs", "layout against circuit", "good" if same else "bad"),
            Tile(str(summary["antennas"]), "antennas", "bad" if summary["antennas"] else "good"),
        ],
        sections=sections,
    )
    (folder / "sram.html").write_text(text, encoding="utf-8")


def picture(gds: Path, process: PixelProcess) -> Figure:
    """Masks of some columns and a strap without and with metals."""
    figure = Figure(figsize=(6, 10), layout="constrained")
    window = 13.2, -18.0, 19.8, 6.0
    masks = [(process.well, WELL), (process.active, ACTIVE), (process.tap, ACTIVE), (process.poly, POLY)]
    metals = [(metal.gds, METALS[k]) for k, metal in enumerate(process.metals[:3])]
    below, above = figure.subplots(1, 2)
    draw_masks(below, gds, [*masks, metals[0]], "up to li1", window)
    draw_masks(above, gds, [*masks, *metals], "up to met2", window)
    return figure
