"""Pads as they are drawn: no rule broken, every one its netlist; the masks that are added, and faults, by name."""

from importlib.util import find_spec

import pytest

from talbot.base.gds import db, read_gds, write_gds
from talbot.base.steps import Runner
from talbot.flow.layout.sensor import pads
from talbot.flow.layout.sensor.steps.die_pads import DiePads, DiePadsDrc, DiePadsLvs
from talbot.flow.layout.steps.library import Library
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.pads import pad_process
from talbot.platforms.pixel import pixel_process

pytest.importorskip("klayout.db", reason="klayout: not installed")

PIXEL = pixel_process("sky130")
NWELL, DIFFUSION = PIXEL.well, PIXEL.active


@pytest.fixture
def layout():
    return db.Layout()


def transistor(layout, gap, thick=False):
    """A cell with a p transistor in a well and a contact on its gate, ``gap`` nm from the diffusion; or thick oxide."""
    cell = layout.create_cell("cell")

    def box(mask, *corners):
        cell.shapes(layout.layer(*mask)).insert(db.Box(*corners))

    box(NWELL if not thick else PIXEL.thick[0][0], -2000, -2000, 4000, 4000)
    box(DIFFUSION, 0, 0, 2000, 1000)
    box(PIXEL.nplus if thick else PIXEL.pplus, -300, -300, 2300, 2500)
    box(PIXEL.poly, 900, -200, 1400, 1000 + gap + 400)
    box(PIXEL.contact, 1065, 1000 + gap, 1235, 1170 + gap)
    box(PIXEL.metals[0].gds, 985, 920 + gap, 1315, 1250 + gap)
    return cell


def region(cell, mask):
    return db.Region(cell.begin_shapes_rec(cell.layout().layer(*mask))).merged()


@pytest.mark.parametrize("gap", [190, 215, 240, 300])
def test_contacts_to_poly_have_room_for_the_implant(layout, gap):
    cell = transistor(layout, gap)
    pads.mend(cell, PIXEL)
    contact, implant, diffusion = (region(cell, mask) for mask in (PIXEL.contact, PIXEL.pplus, DIFFUSION))
    assert contact.bbox().bottom == max(1000 + gap, 1235) and contact.count() == 1
    assert (contact.sized(110) & implant).is_empty() and (diffusion.sized(125) - implant).is_empty()
    assert (contact.sized(100) - region(cell, PIXEL.contact_poly)).is_empty()
    assert (contact - region(cell, PIXEL.poly)).is_empty()
    assert (contact - region(cell, PIXEL.metals[0].gds)).is_empty()


def test_thick_oxide_has_its_tip_implant_and_thin_none(layout):
    cell = transistor(layout, 190, thick=True)
    pads.mend(cell, PIXEL)
    assert (db.Region(db.Box(0, 0, 2000, 1000)).sized(185) - region(cell, PIXEL.thick[1][0])).is_empty()
    cell = transistor(layout, 190)
    pads.mend(cell, PIXEL)
    assert region(cell, PIXEL.thick[1][0]).is_empty()


def test_taps_are_on_their_own_mask(layout):
    cell = transistor(layout, 190)
    cell.shapes(layout.layer(*DIFFUSION)).insert(db.Box(3000, 0, 3500, 500))
    cell.shapes(layout.layer(*PIXEL.nplus)).insert(db.Box(2800, -200, 3700, 700))
    pads.split(cell, PIXEL, pad_process("sky130").tap)
    assert str(region(cell, pad_process("sky130").tap)) == "(3000,0;3000,500;3500,500;3500,0)"
    assert region(cell, DIFFUSION).bbox() == db.Box(0, 0, 2000, 1000)


def test_grounds_are_one_net_in_pads_alone():
    spice = ".subckt IOPadIn vss vdd iovss pad\nX1 iovss pad vss Clamp\n.ends IOPadIn\n"
    clamp = ".subckt Clamp iovss pad vss\nM1 pad iovss iovss iovss nmos\n.ends Clamp\n"
    made = pads.joined(spice + clamp, pad_process("sky130"))
    assert made == ".subckt IOPadIn vss vdd pad\nX1 vss pad vss Clamp\n.ends IOPadIn\n" + clamp


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.skipif(find_spec("c4m") is None, reason="c4m-pdk-sky130: not installed")
def test_the_pads_keep_all_rules_and_a_fault_is_named(tmp_path):
    runner, parameters = Runner(tmp_path, {}), PdkParameters()
    runner.run(Library())
    assert runner.run(DiePads(parameters))["metrics"] == {"pad_cells": len(pad_process("sky130").cells)}
    assert runner.run(DiePadsDrc(parameters))["metrics"] == {"pad_drc_violations": 0}
    assert runner.run(DiePadsLvs(parameters))["metrics"] == {"pads_unmatched": 0}
    layout = read_gds(runner.paths["die_pads.gds"])
    pad = layout.cell("IOPadAnalog")
    clamp = pad.shapes(layout.layer(*PIXEL.poly))  # a clamp's gate is cut off
    max(clamp.each(), key=lambda shape: shape.bbox().height()).delete()
    opening = layout.cell("IOPadIn").shapes(layout.layer(*PIXEL.contact_poly))
    next(opening.each()).delete()
    runner.paths["die_pads.gds"] = tmp_path / "faults.gds"
    write_gds(layout, runner.paths["die_pads.gds"])
    assert runner.run(DiePadsLvs(parameters))["metrics"] == {"pads_unmatched": 1}
    assert '"IOPadAnalog": false' in runner.paths["die_pads_lvs.verdicts"].read_text()
    assert runner.run(DiePadsDrc(parameters))["metrics"]["pad_drc_violations"] > 0
    assert "licon.18" in runner.paths["die_pads_drc.summary"].read_text()
