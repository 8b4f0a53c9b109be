"""Fill outside of the blocks: its share, and how far it keeps from what carries a signal."""

import json

import pytest

from talbot.base.gds import db
from talbot.flow.layout.sensor import outside
from talbot.flow.layout.sensor.plan import nm
from talbot.flow.layout.sensor.test import small
from talbot.platforms.die import top_metal
from talbot.platforms.layout import layout_platform

pytestmark = pytest.mark.needs("layout")
METALS = *layout_platform("sky130").metals, top_metal("sky130").metal


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """(plan of a small die, layout with its fill alone, shares)."""
    folder = tmp_path_factory.mktemp("fill")
    given = small.files(folder)
    small.plan(given, folder)
    plan, layout = json.loads(given["die_plan.plan"].read_text()), db.Layout()
    layout.dbu = 0.001
    return plan, layout, outside.fill(layout, layout.create_cell("die"), plan, METALS)


def squares(layout, metal):
    return db.Region(layout.top_cell().begin_shapes_rec(layout.layer(*metal.gds)))


@pytest.mark.parametrize("metal", METALS, ids=lambda metal: metal.lef)
def test_fill_keeps_away_from_wires(filled, metal):
    plan, layout, _ = filled
    drawn = squares(layout, metal)
    boxes = [box for _, layer, datatype, *box in plan["shapes"] if (layer, datatype) == metal.gds]
    wires = db.Region([db.Box(*box) for box in boxes])
    assert drawn.count() > 100 and (drawn.sized(nm(outside.CLEARANCE_UM) - 1) & wires).is_empty()
    assert all(square.is_box() and square.area() == nm(outside.SIDE_UM) ** 2 for square in drawn.each())
    assert drawn.space_check(nm(outside.STEP_UM - outside.SIDE_UM)).is_empty()


def test_fill_keeps_away_from_blocks_and_pads(filled):
    plan, layout, _ = filled
    drawn = sum((squares(layout, metal) for metal in METALS), db.Region()).sized(nm(outside.APART_UM) - 1)
    for block in plan["blocks"].values():
        assert (drawn & db.Region(db.Box(*block["box"]))).is_empty()
    for pad in plan["ring"]:
        assert (drawn & db.Region(db.Box(*pad["box"]))).is_empty()


def test_the_share_counts_wires_and_fill(filled):
    """A metal without a wire has the share of the squares, but for a row at the edges."""
    plan, _, shares = filled
    bare = (outside.SIDE_UM / outside.STEP_UM) ** 2
    used = {(layer, datatype) for _, layer, datatype, *_ in plan["shapes"]}
    empty = [metal.lef for metal in METALS if metal.gds not in used]
    assert empty and all(0.85 * bare < shares[name] <= bare for name in empty)
    assert all(0.3 < share < 0.6 for share in shares.values()), shares
