"""The rules that PDKMaster's deck lacks: cells of two libraries, and an error planted against each."""

import re
from collections import Counter
from xml.etree import ElementTree

import pytest

from talbot.base.gds import db, write_gds
from talbot.base.tools import finish
from talbot.platforms.sky130.layout import PLATFORM

NWELL, ACTIVE, POLY, LICON, NPC = (64, 20), (65, 20), (66, 20), (66, 44), (95, 20)
TAP, NSDM, PSDM, HVTP, LVTN = (65, 44), (93, 44), (94, 20), (78, 44), (125, 44)

# An n transistor with a gate contact below, a p transistor above it in its well, and a tap of each, in nm
GOOD = [
    (ACTIVE, 0, 0, 1000, 500),
    (NSDM, -125, -125, 1125, 625),
    (POLY, 425, -600, 575, 630),
    (POLY, 335, -700, 665, -430),
    (LICON, 415, -650, 585, -480),
    (NPC, 315, -750, 685, -380),
    (LICON, 100, 165, 270, 335),
    (TAP, 2000, 0, 2500, 500),  # p tap
    (PSDM, 1870, -130, 2630, 630),
    (LICON, 2165, 165, 2335, 335),
    (NWELL, -500, 1500, 3000, 3500),
    (ACTIVE, 0, 2000, 1000, 2500),
    (PSDM, -125, 1875, 1125, 2625),
    (POLY, 425, 1870, 575, 2630),
    (TAP, 2000, 2000, 2500, 2500),  # n tap
    (NSDM, 1870, 1870, 2630, 2630),
    (LICON, 2165, 2165, 2335, 2335),
]


def without(*left_out):
    return [shape for shape in GOOD if shape[0] not in left_out]


PLANTED = {
    "npc.1": [*GOOD, (NPC, 3500, 0, 3760, 1000)],
    "npc.2": [*GOOD, (NPC, 945, -750, 1400, -380)],
    "npc.4": [*GOOD, (NPC, 315, -380, 685, -89)],
    "licon.13": [*GOOD, (NPC, -400, 100, 11, 400)],
    "licon.15": [*without(NPC), (NPC, 316, -750, 684, -380)],
    "licon.18": without(NPC),
    "licon.9": [*GOOD, (PSDM, 694, -900, 1300, -400)],
    "licon.11": [*GOOD, (LICON, 205, 100, 375, 270)],
    "licon.14": [*GOOD, (ACTIVE, 774, -800, 1200, -400), (NSDM, 600, -925, 1325, -275)],
    "licon.17": [*GOOD, (LICON, 340, 400, 510, 570)],
    "nsd.1": [*GOOD, (NSDM, 4000, 0, 4370, 2000)],
    "psd.2": [*GOOD, (PSDM, 3005, -130, 3700, 630)],
    "nsd.area": [*GOOD, (NSDM, 4000, 0, 4500, 500)],
    "hvtp.hole": [
        *GOOD,
        (HVTP, 4000, 0, 5300, 400),
        (HVTP, 4000, 900, 5300, 1300),
        (HVTP, 4000, 0, 4400, 1300),
        (HVTP, 4900, 0, 5300, 1300),
    ],
    "nsd.8": [*GOOD, (NSDM, 2400, -400, 3200, 400)],
    "nsd.5": [*GOOD, (ACTIVE, 4000, 0, 4500, 500)],
    "psd.5": [*GOOD, (TAP, 2500, 0, 2520, 500)],
    "nsd.7": [*GOOD, (NSDM, 2629, -130, 3500, 630)],
    "psd.7": [*GOOD, (PSDM, 1129, -700, 1800, 700)],
    "nwell.1": [*GOOD, (NWELL, 6000, 0, 6830, 3000)],
    "nwell.2a": [*GOOD, (NWELL, 4269, 1500, 6000, 3500)],
    "nwell.4": [*GOOD, (NWELL, 6000, 1500, 8000, 3500)],
    "difftap.8": [*without(NWELL), (NWELL, -179, 1500, 3000, 3500)],
    "difftap.9": [*without(NWELL), (NWELL, -500, 839, 3000, 3500)],
    "difftap.10": [*without(NWELL), (NWELL, -500, 1500, 2679, 3500)],
    "difftap.11": [*GOOD, (NWELL, 2629, 0, 3600, 3500)],
    "tap": [*without(TAP), *((ACTIVE, *box) for layer, *box in GOOD if layer == TAP)],
    "lu.2": [*GOOD, (ACTIVE, 18000, 0, 18500, 500), (NSDM, 17875, -125, 18625, 625)],
    "hvtp.3": [*GOOD, (HVTP, 246, 1700, 900, 2800)],
    "hvtp.4": [*GOOD, (HVTP, 754, 1700, 1500, 2800)],
    "lvtn.3a": [*GOOD, (LVTN, 754, -200, 1500, 700)],
    "lvtn.4b": [*GOOD, (LVTN, 246, -300, 900, 800)],
    "lvtn.9": [*GOOD, (LVTN, 5000, 0, 6000, 1000), (HVTP, 6379, 0, 7000, 1000)],
}


GRID = 100_000  # nm from one case to the next, farther than any rule looks


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    """Rules that each case breaks, and how often: all cases in one layout, one above the other. KLayout's start takes
    longer than the rules."""
    folder = tmp_path_factory.mktemp("masks")
    layout, gds, report = db.Layout(), folder / "drawn.gds", folder / "report.lyrdb"
    top, cases = layout.create_cell("top"), {"good": GOOD} | PLANTED
    for number, shapes in enumerate(cases.values()):
        for layer, *box in shapes:
            top.shapes(layout.layer(*layer)).insert(db.Box(*box).moved(0, number * GRID))
    write_gds(layout, gds)
    deck = folder / "masks.drc"
    deck.write_text(f'source("{gds}")\nreport("masks", "{report}")\n{PLATFORM.masks.read_text()}')
    done = finish(["klayout", "-b", "-r", deck])
    assert not done.returncode, done.stderr
    found = {name: Counter() for name in cases}
    for item in ElementTree.parse(report).getroot().iterfind("items/item"):
        y = float(re.search(r"\([-\d.]+,([-\d.]+)", item.findtext("values/value"))[1])  # um
        found[list(cases)[round(1000 * y / GRID)]][item.findtext("category").strip("'")] += 1
    return found


pytestmark = pytest.mark.needs("klayout", "layout")


def test_what_keeps_every_rule(broken):
    assert not broken["good"]


@pytest.mark.parametrize("rule", PLANTED)
def test_a_planted_error(broken, rule):
    assert broken[rule][rule]
