"""The gallery: a small frame in every mode, made here by the golden model, and the results that are in build/."""

import base64
from pathlib import Path

from talbot import Run, Sensor
from talbot.base.page import index

SIDE = 192
MODES = {"edge": "Edge mode", "image": "Image mode", "raw": "Raw mode", "tof": "Time of flight"}
HEAD = """# Gallery

Every mode on the scene `motorcycle`, {side} x {side} pixels, made with this page by the golden model, whose bytes are
those of the chip (`talbot.Sensor(...).golden(mode=...)`).
"""
RESULTS = """
## Results

Made by `make` before this page; `build/index.html` leads to their own pages.
"""


def frames() -> dict[str, Run]:
    """A frame in every mode."""
    sensor = Sensor(rows=SIDE, cols=SIDE)
    life_size = sensor.replace(focus=3.0, scale=1.0)  # unscaled, the scene is a few metres deep
    return {mode: (life_size if mode == "tof" else sensor).golden(mode=mode) for mode in MODES}


def write(source: Path, results: Path) -> None:
    """Write gallery.md and its pictures; results: folder of those of `make`."""
    folder = source / "pictures"
    folder.mkdir()
    lines = [HEAD.format(side=SIDE)]
    for mode, run in frames().items():
        (folder / f"{mode}.png").write_bytes(run._repr_png_())
        lines += [f"## {MODES[mode]}", "", f"![{MODES[mode]}](pictures/{mode}.png)", ""]
        if mode == "raw":
            (folder / "edges.png").write_bytes(run.reconstruct("edges")._repr_png_() or b"")
            lines += ["The differences of each of the 24 pixel types:", "", "![edges](pictures/edges.png)", ""]
    cards = [card for card in index.cards(results) if card.picture]
    lines += [RESULTS] if cards else []
    for number, card in enumerate(cards):
        _, _, data = card.picture.partition(",")
        (folder / f"result{number}.webp").write_bytes(base64.b64decode(data))
        figures = "; ".join(f"{tile.value} {tile.label}" for tile in card.tiles)
        lines += [f"### {card.title}", "", f"`{card.folder}`, {card.when}: {figures}", ""]
        lines += [f"![{card.title}](pictures/result{number}.webp)", ""]
    (source / "gallery.md").write_text("\n".join(lines))
