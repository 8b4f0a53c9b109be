"""The files of a library of three cells: taps are on their own mask, the abstract has every contact."""

import pytest

from talbot.base.gds import db, read_gds
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.catalogue import schematics
from talbot.cells.compact.make import make, recipe
from talbot.cells.compact.ties import diode, ties
from talbot.platforms.sky130 import layers

pytestmark = pytest.mark.needs("layout")
CELLS = "inv_x1", "tie", "diode_w1"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    from talbot.cells.compact.pdk import to_pdkmaster
    from talbot.cells.compact.write import write

    canvas, schematic = Canvas(), schematics()["inv_x1"]
    drawn = {"inv_x1": (schematic, make(schematic, canvas, recipe("inv_x1"))), **ties(canvas), **diode(canvas)}
    folder = tmp_path_factory.mktemp("compact")
    write(to_pdkmaster("small", canvas, {name: drawn[name] for name in CELLS}), canvas, folder)
    return folder


@pytest.mark.parametrize("name", CELLS)
def test_taps_are_on_their_own_mask(folder, name):
    layout = read_gds(folder / "compact.gds")

    def region(layer):
        return db.Region(layout.cell(name).begin_shapes_rec(layout.layer(*layer))).merged()

    diffusion, tap, well = region(layers.DIFF), region(layers.TAP), region(layers.NWELL)
    nplus, pplus = region(layers.NSDM), region(layers.PSDM)
    assert tap.count() == 2 and (tap & diffusion).is_empty()  # under both rails
    assert (diffusion & nplus & well).is_empty() and ((diffusion & pplus) - well).is_empty()
    assert not (tap & nplus & well).is_empty() and not ((tap & pplus) - well).is_empty()
    assert diffusion.count() == {"inv_x1": 2, "tie": 0, "diode_w1": 1}[name]


def test_the_abstract_has_every_contact_between_li_and_met1(folder):
    layout = read_gds(folder / "compact.gds")
    _, _, macro = (folder / "compact.lef").read_text().partition("MACRO inv_x1")
    contacts = macro.partition("END inv_x1")[0].split("LAYER mcon ;")[1:]
    drawn = db.Region(layout.cell("inv_x1").begin_shapes_rec(layout.layer(*layers.MCON.gds))).merged()
    assert sum(len(part.split("LAYER")[0].split("END")[0].split("RECT")) - 1 for part in contacts) == drawn.count() > 2
