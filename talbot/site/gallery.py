"""The gallery: a small frame in every mode, made here by the golden model, and the results that are in build/."""

import base64
import shutil
import tempfile
from pathlib import Path

from PIL import Image
from skimage import data

from talbot import Run, Sensor
from talbot.base.animation import Animation
from talbot.base.page import index
from talbot.imaging.frame import pictures
from talbot.imaging.lightfield.page import MOVING as VIEWS
from talbot.imaging.sequence.outputs import ANIMATIONS, SCALE

SIDE = 192
FRAMES, STEP, FRAME_S = 16, 6, 0.1  # of the animation: px a frame, s
MODES = {
    "edge": "Edge mode",
    "image": "Image mode",
    "raw": "Raw mode",
    "tof": "Time of flight",
    "ternary": "Ternary mode",
}
HEAD = """# Gallery

Every mode on the scene `motorcycle`, {side} x {side} pixels, made with this page by the golden model, whose bytes are
those of the chip (`talbot.Sensor(...).golden(mode=...)`).
"""
CLIP = """## A sequence

A window that moves over a photograph, in edge mode, frame by frame: red and blue are positive and negative differences.
`make sequence SCENE=clip.gif` makes the same of a clip, through the chip's Verilog.

![sequence](pictures/sequence.webp)
"""
RESULTS = """
## Results

Made by `make` before this page; `build/index.html` leads to their own pages.
"""


def frames() -> dict[str, Run]:
    """Return a frame in every mode."""
    sensor = Sensor(rows=SIDE, cols=SIDE)
    life_size = sensor.replace(focus=3.0, scale=1.0)  # unscaled, the scene is a few metres deep
    return {mode: (life_size if mode == "tof" else sensor).golden(mode=mode) for mode in MODES}


def clip(path: Path) -> None:
    """Write the animation of a sequence."""
    photograph, sensor = Image.fromarray(data.camera()), Sensor(rows=SIDE, cols=SIDE)
    with Animation(path) as animation, tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        for left in range(100, 100 + FRAMES * STEP, STEP):
            seen = Path(folder) / f"{left}.png"  # a file: pictures stand behind the focal plane
            photograph.crop((left, 60, left + SIDE, 60 + SIDE)).save(seen)
            samples = sensor.golden(seen).samples
            animation.add(pictures.signed_codes(samples[..., 0], SCALE), FRAME_S)


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
    clip(folder / "sequence.webp")
    lines += [CLIP]
    cards = [card for card in index.cards(results) if card.picture]
    lines += [RESULTS] if cards else []
    for number, card in enumerate(cards):
        picture(card, results, folder / f"result{number}.webp")
        figures = "; ".join(f"{tile.value} {tile.label}" for tile in card.tiles)
        lines += [f"### {card.title}", "", f"`{card.folder}`, {card.when}: {figures}", ""]
        lines += [f"![{card.title}](pictures/result{number}.webp)", ""]
    (source / "gallery.md").write_text("\n".join(lines), encoding="utf-8")


def picture(card: index.Card, results: Path, out: Path) -> None:
    """Write the picture of a result: its animation, where it has one. results: folder that the card was read in."""
    for name in (*sorted({*ANIMATIONS.values()}), VIEWS):
        if (moving := results / card.folder / name).is_file():
            shutil.copyfile(moving, out)
            return
    out.write_bytes(base64.b64decode(card.picture.partition(",")[2]))
