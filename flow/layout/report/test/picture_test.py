"""The picture of a layout: every layer where it is, fill apart from the metal that it is drawn on."""

import numpy as np
import pytest
from PIL import Image

from talbot.base.gds import db, write_gds
from talbot.flow.layout.report.picture import BACKGROUND, by_block, clock_tree, congestion, render
from talbot.platforms.layout import layout_platform
from talbot.signoff.netlist.netlist import Instance, Netlist

pytestmark = pytest.mark.needs("layout")

TECH = layout_platform("sky130")
SIDE = 100


@pytest.fixture
def files(tmp_path):
    """10 x 5 um with a metal over the left fifth; the same with a square of fill."""
    layout, paths = db.Layout(), (tmp_path / "plain.gds", tmp_path / "filled.gds")
    layout.dbu = 0.001
    top, metal = layout.create_cell("top"), layout.layer(*TECH.metals[1].gds)
    top.shapes(layout.layer(*TECH.outline)).insert(db.Box(0, 0, 10000, 5000))
    top.shapes(metal).insert(db.Box(0, 0, 2000, 5000))
    write_gds(layout, paths[0])
    top.shapes(metal).insert(db.Box(6000, 1000, 8000, 3000))
    write_gds(layout, paths[1])
    return paths


def shares(picture):
    """Layer to the share of the picture that it covers."""
    return {layer.name: np.asarray(layer.mask).mean() for layer in picture.layers}


def test_fill_is_a_layer_of_its_own(files):
    plain, filled = files
    picture, name = render(filled, TECH, plain, SIDE), TECH.metals[1].name
    assert (picture.width_um, picture.height_um) == (10, 5) and picture.layers[0].mask.size == (SIDE, SIDE // 2)
    found = shares(picture)
    assert found["fill"] == pytest.approx(0.08, abs=0.01) and found[name] == pytest.approx(0.2, abs=0.02)
    fill = np.asarray(next(layer for layer in picture.layers if layer.name == "fill").mask)
    rows, cols = np.nonzero(fill)
    assert rows.min() >= 19 and rows.max() <= 41 and cols.min() >= 59 and cols.max() <= 81  # y is upward
    assert [value for other, value in found.items() if other not in ("fill", name)] == [0] * (len(found) - 2)


def test_without_the_plain_layout_fill_is_metal(files):
    found = shares(render(files[1], TECH, side=SIDE))
    assert "fill" not in found and found[TECH.metals[1].name] == pytest.approx(0.28, abs=0.02)


def test_the_whole_picture_and_its_layers_have_the_same_colours(files):
    picture = render(files[1], TECH, files[0], SIDE)
    colors = {color for _, color in picture.image.getcolors()}
    shown = {tuple(layer.rgb.to_bytes(3, "big")) for layer in picture.layers if np.asarray(layer.mask).any()}
    assert colors == shown | {BACKGROUND}
    assert all(layer.src.startswith("data:image/png") for layer in picture.layers)


def test_cells_by_block_are_drawn_with_all_their_labels_beside_the_pages_buttons(tmp_path):
    """Nothing touches the picture's edge, and the corner where the page has its buttons is free."""
    netlist = Netlist("top", (), (Instance("a", "cell", {"A": "n"}), Instance("b", "cell", {"A": "n"})))
    placed = [["a", "cell", 0.0, 0.0, "0"], ["b", "cell", 50.0, 50.0, "0"]]
    plan = {"width_um": 131.0, "height_um": 125.0}
    found = {"a": "top", "b": "clock tree"}
    by_block(tmp_path / "blocks.png", netlist, placed, {"cell": 400.0}, TECH, found, plan)
    ink = np.asarray(Image.open(tmp_path / "blocks.png").convert("L")) < 250
    assert ink.any() and not (ink[[0, -1]].any() or ink[:, [0, -1]].any())
    assert not ink[: len(ink) // 10, -ink.shape[1] // 10 :].any()


def test_the_clock_tree_ends_at_registers(tmp_path):
    """A buffer behind the port, two registers behind it; what a register drives is not followed."""
    buffer, loop = Instance("b", "buf_x1", {"i": "clk", "q": "n"}), {"clk": "n", "i": "d", "q": "d"}
    netlist = Netlist("top", (), (buffer, Instance("r", "dff_x1", loop), Instance("s", "dff_x1", loop)))
    placed = [[None, "cell", x, x, "0"] for x in (10.0, 40.0, 80.0)]
    clock_tree(tmp_path / "clock.png", netlist, placed, "clk", {"width_um": 100.0, "height_um": 100.0})
    assert (np.asarray(Image.open(tmp_path / "clock.png").convert("L")) < 250).any()


def test_congestion_is_drawn_where_metal_is(files, tmp_path):
    congestion(tmp_path / "c.png", render(files[0], TECH, side=SIDE), [TECH.metals[1].name], 1.0)
    assert len(Image.open(tmp_path / "c.png").convert("RGB").getcolors(100_000)) > 10
