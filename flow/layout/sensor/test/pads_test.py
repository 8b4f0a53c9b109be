"""Pads as they are drawn: no rule broken, every one its netlist; the masks that are added, and faults, by name."""

import re

import pytest

from talbot.base.gds import db, read_gds, write_gds
from talbot.base.steps import Runner
from talbot.flow.layout.sensor import esd, pads
from talbot.flow.layout.sensor.metrics import RULES
from talbot.flow.layout.sensor.steps.die_pads import DiePads, DiePadsDrc, DiePadsLvs
from talbot.flow.layout.steps.library import Library
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.pads import esd_models, pad_process
from talbot.platforms.pixel import pixel_process

pytestmark = pytest.mark.needs("layout")

PIXEL = pixel_process("sky130")
NWELL, DIFFUSION = PIXEL.well, PIXEL.active


@pytest.fixture
def layout():
    return db.Layout()


def draw(cell, mask, *corners):
    cell.shapes(cell.layout().layer(*mask)).insert(db.Box(*corners))


def transistor(layout, gap, thick=False):
    """A cell with a p transistor in a well and a contact on its gate, ``gap`` nm from the diffusion; or thick oxide."""
    cell = layout.create_cell("cell")
    draw(cell, NWELL if not thick else PIXEL.thick[0][0], -2000, -2000, 4000, 4000)
    draw(cell, DIFFUSION, 0, 0, 2000, 1000)
    draw(cell, PIXEL.nplus if thick else PIXEL.pplus, -300, -300, 2300, 2500)
    draw(cell, PIXEL.poly, 900, -200, 1400, 1000 + gap + 400)
    draw(cell, PIXEL.contact, 1065, 1000 + gap, 1235, 1170 + gap)
    draw(cell, PIXEL.metals[0].gds, 985, 920 + gap, 1315, 1250 + gap)
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
    draw(cell, DIFFUSION, 3000, 0, 3500, 500)
    draw(cell, PIXEL.nplus, 2800, -200, 3700, 700)
    pads.split(cell, PIXEL, pad_process("sky130").tap)
    assert str(region(cell, pad_process("sky130").tap)) == "(3000,0;3000,500;3500,500;3500,0)"
    assert region(cell, DIFFUSION).bbox() == db.Box(0, 0, 2000, 1000)


@pytest.mark.parametrize("thin", [False, True])
def test_thick_oxide_is_over_all_of_its_well(layout, thin):
    """And over what goes on of it in the next cell; not where a thin-oxide transistor is in it, in either of them."""
    tap, thick = pad_process("sky130").tap, PIXEL.thick[0][0]
    cells = [layout.create_cell(name) for name in ("pad", "filler")]
    for cell in cells:
        draw(cell, NWELL, -180, 0, 5180, 840)
        draw(cell, tap, 0, 295, 5000, 545)
        draw(cell, PIXEL.nplus, -125, 170, 5125, 670)
        draw(cell, NWELL, 1000, 6000, 3000, 8000)  # another one, without thick oxide
    draw(cells[0], thick, 2000, -300, 3000, 900)
    if thin:
        draw(cells[1], DIFFUSION, 4000, 300, 4200, 500)
        draw(cells[1], PIXEL.poly, 4050, 0, 4150, 800)
    pads.cover_wells(cells, PIXEL, tap)
    for cell in cells:
        well = region(cell, NWELL)
        low, other = (well & db.Region(db.Box(-9000, y, 9000, y + 500)) for y in (0, 6000))
        assert (low - region(cell, thick)).is_empty() != thin
        assert (other & region(cell, thick)).is_empty()
        if not thin:
            taps = region(cell, tap)
            assert taps.bbox().height() >= 290 and (taps.sized(330) - well).is_empty()
            assert (taps.sized(125) - region(cell, PIXEL.nplus)).is_empty()


def test_a_tap_in_thick_oxide_is_apart_from_a_diode(layout):
    tap, cell = pad_process("sky130").tap, layout.create_cell("cell")
    for mask, *corners in (
        (NWELL, 0, 0, 9000, 3000),
        (PIXEL.thick[0][0], 500, 500, 8500, 2500),
        (DIFFUSION, 2000, 1000, 6000, 1750),
        (tap, 2000, 2000, 6000, 2600),
    ):
        draw(cell, mask, *corners)
    pads.cover_wells([cell], PIXEL, tap)
    assert region(cell, tap).bbox().bottom == 1750 + 370


def test_grounds_are_one_net_in_pads_alone():
    spice = ".subckt IOPadIn vss vdd iovss pad\nX1 iovss pad vss Clamp\n.ends IOPadIn\n"
    clamp = ".subckt Clamp iovss pad vss\nM1 pad iovss iovss iovss nmos\n.ends Clamp\n"
    made = pads.joined(spice + clamp, pad_process("sky130"))
    assert made == ".subckt IOPadIn vss vdd pad\nX1 vss pad vss Clamp\n.ends IOPadIn\n" + clamp


def check_core_clamp(spice, layout):
    """The core's clamp limits a discharge, its metal carries it, it is off in operation; without it the limit fails."""
    process, most = pad_process("sky130"), RULES["esd_core_v"]["most"]
    name, models = process.supplies["vdd"], esd_models("sky130")
    lines = models.lines(spice)
    for sign in (1, -1):
        clamped = esd.stress(lines, process, name, "vdd", esd.HBM, "vss", sign, 1)
        assert clamped.core < 2.2 < most  # docs/results/layout.md
    start = spice.index(f".subckt {name} ")
    end = spice.index(".ends", start)
    fingers = re.sub(r"(?m)^Mclamp.*\n", "", spice[start:end])
    without = esd.stress(
        models.lines(spice[:start] + fingers + spice[end:]), process, name, "vdd", esd.HBM, "vss", 1, 1
    )
    assert without.core > most
    quiet = esd.quiet(models.lines(spice, "ss", leakage=True), models.lines(spice, "ff"), process)
    assert quiet.leak < 2e-6 and quiet.rise < 20e-6 and quiet.ripple < 2e-6
    assert heating(region(layout.cell(name), PIXEL.metals[1].gds)) < 50


def heating(metal):
    """Kelvin by which a discharge heats the metal from the bond pad to the clamp's drains, if no heat leaves it.

    100 pF at 2 kV give 0.133 uA2s through 1500 ohm. metal: 0.36 um thick, 0.125 ohm, 2.44 MJ/m3/K.
    """
    strips = metal & db.Region(db.Box(4_500, 86_400, 85_500, 86_800))
    width, thickness = sum(strip.bbox().width() for strip in strips.each()) * 1e-9, 0.36e-6
    charge2 = 0.5 * esd.HBM.farad * esd.HBM.volts**2 / esd.HBM.ohm
    return 0.125 * thickness * charge2 / (width * thickness) ** 2 / 2.44e6


@pytest.mark.slow
@pytest.mark.timeout(3600)
@pytest.mark.needs("layout", "ngspice")
def test_the_pads_keep_all_rules_and_a_fault_is_named(tmp_path):
    runner, parameters = Runner(tmp_path, {}), PdkParameters()
    runner.run(Library())
    assert runner.run(DiePads(parameters))["metrics"] == {"pad_cells": len(pad_process("sky130").cells)}
    assert runner.run(DiePadsDrc(parameters))["metrics"] == {"pad_drc_violations": 0}
    assert runner.run(DiePadsLvs(parameters))["metrics"] == {"pads_unmatched": 0}
    spice, layout = runner.paths["die_pads.spice"].read_text(), read_gds(runner.paths["die_pads.gds"])
    lines = esd_models("sky130").lines(spice)
    one, two = (esd.stress(lines, pad_process("sky130"), "IOPadIn", "pad", esd.HBM, "vss", 1, n) for n in (1, 2))
    assert 10.5 < one.pad < 11.7 and 8.9 < two.pad < 10.3  # docs/results/layout.md
    check_core_clamp(spice, layout)
    pad = layout.cell("IOPadAnalog")
    clamp = pad.shapes(layout.layer(*PIXEL.poly))  # a clamp's gate is cut off
    max(clamp.each(), key=lambda shape: shape.bbox().height()).delete()
    opening = layout.cell("IOPadIn").shapes(layout.layer(*PIXEL.contact_poly))
    next(opening.each()).delete()
    vss = layout.cell("IOPadVss")  # thick oxide ends in the clamp's well, next to its tap
    thick = vss.shapes(layout.layer(*PIXEL.thick[0][0]))
    whole = max(thick.each(), key=lambda shape: shape.bbox().height())
    box = whole.bbox()
    short = db.Region(whole.polygon) - db.Region(db.Box(box.left, box.bottom, box.left + 200, box.top))
    whole.delete()
    thick.insert(short)
    runner.paths["die_pads.gds"] = tmp_path / "faults.gds"
    write_gds(layout, runner.paths["die_pads.gds"])
    assert runner.run(DiePadsLvs(parameters))["metrics"] == {"pads_unmatched": 1}
    assert '"IOPadAnalog": false' in runner.paths["die_pads_lvs.verdicts"].read_text()
    assert runner.run(DiePadsDrc(parameters))["metrics"]["pad_drc_violations"] > 0
    broken = runner.paths["die_pads_drc.summary"].read_text()
    assert "licon.18" in broken and "nwell.9" in broken
