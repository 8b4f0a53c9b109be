"""A picture of the test chip's masks."""

from pathlib import Path

from matplotlib.figure import Figure

from talbot.pixels.layout.pixel import UPPER
from talbot.pixels.pixel_layout.pictures import ACTIVE, METALS, POLY, WELL, draw_masks
from talbot.platforms.pixel import PixelProcess


def picture(gds: Path, process: PixelProcess, path: Path) -> None:
    """Draw all masks, and next to them the pixels' upper gratings."""
    figure = Figure(figsize=(10, 7.6), layout="constrained")
    whole, upper = figure.subplots(1, 2)
    masks = [(process.well, WELL), (process.active, ACTIVE), (process.tap, ACTIVE), (process.poly, POLY)]
    metals = [(metal.gds, METALS[k]) for k, metal in enumerate(process.metals[: UPPER + 1])]
    draw_masks(whole, gds, [*masks, *metals], "all masks")
    draw_masks(upper, gds, [masks[0], metals[UPPER]], f"wells, {process.metals[UPPER].lef}", (30, 80, 94, 134))
    figure.savefig(path, dpi=150)
