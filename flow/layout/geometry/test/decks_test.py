"""What is changed of PDKMaster's decks, and a deck that cannot be changed so."""

import shutil

import pytest

from talbot.base.gds import db, write_gds
from talbot.base.steps import StepError
from talbot.flow.layout.geometry.decks import broken_rules, deep_and_flat, run_deck, via_rules, violations
from talbot.flow.layout.geometry.lvs_deck import hierarchical
from talbot.platforms.coriolis import coriolis_platform

DRC = """deep
nwm = input(64, 20)
both = (nwm&li)
nwm.space(1.27).output(
    "nwm space", "nwm minimum space"
)
both.space(0.2).output(
    "both space", "both minimum space"
)
nwm.width(0.84).output(
    "nwm width", "nwm minimum width"
)
"""
LVS = """schematic(x)
flat
_wafer = extent.sized(0.34)
substrate__Sky130 = (_wafer-nwm)
connect(substrate__Sky130, _wafer)
connect(poly, poly_pin)
"""


def test_spaces_of_drawn_layers_are_checked_flat_and_the_rest_as_before():
    deep, flat = deep_and_flat(f"source(x)\n{DRC}", ["more"])
    assert deep.startswith("source(x)\ndeep\nnwm = ")
    assert "nwm.space" not in deep and "both.space(0.2)" in deep and "nwm.width" in deep
    spaces = 'nwm = input(64, 20)\nnwm.edges.space(1.27).output(\n    "nwm space", "nwm minimum space"\n)\n'
    assert flat == f"source(x)\nflat\n{spaces}\nmore\n"


@pytest.mark.skipif(not shutil.which("klayout"), reason="klayout: not found; install it with: make tools")
@pytest.mark.parametrize(
    "cases, found",
    (
        ([(500, [200]), (800, [200, 600])], {}),
        ([(350, [200]), (200, [200]), (800, [200, 335])], {"via3 outside m4": 2, "via3 size": 2}),  # two vias are one
    ),
)
def test_a_via_outside_its_metal_or_of_another_size_is_found(tmp_path, cases, found):
    """Cases, side by side: height of the upper metal, and where vias begin."""
    tech, layout = coriolis_platform("sky130"), db.Layout()
    top = layout.create_cell("top")
    for x, (end, vias) in enumerate(cases):
        shapes = (tech.metals[3].gds, (0, 0, 500, 800)), (tech.metals[4].gds, (0, 0, 500, end))
        for at, box in (*shapes, *((tech.vias[3].gds, (150, low, 350, low + 200)) for low in vias)):
            top.shapes(layout.layer(*at)).insert(db.Box(*box).moved(5000 * x, 0))
    write_gds(layout, tmp_path / "top.gds")
    head = f"source('{tmp_path}/top.gds')\nreport('vias', '{tmp_path}/found.lyrdb')"
    (tmp_path / "vias.drc").write_text("\n".join([head, *via_rules(tech), ""]))
    run_deck(tmp_path / "vias.drc", tmp_path / "found.lyrdb", {})
    assert violations(tmp_path / "found.lyrdb") == found


@pytest.mark.skipif(not shutil.which("klayout"), reason="klayout: not found; install it with: make tools")
def test_decks_run_at_once_and_their_violations_are_in_one_report(tmp_path):
    layout = db.Layout()
    top = layout.create_cell("top")
    for x, width in ((0, 1000), (2000, 800), (5000, 900)):  # a space of 1 um, a width of 0.8
        top.shapes(layout.layer(64, 20)).insert(db.Box(x, 0, x + width, 2000))
    write_gds(layout, tmp_path / "top.gds")
    head = 'source(ENV["SOURCE_FILE"])\nreport("r", ENV["REPORT_FILE"])\n'
    decks = deep_and_flat(head + DRC.replace("(nwm&li)", "nwm & nwm"))
    files = {tmp_path / f"{name}.drc": deck for name, deck in zip(("deep", "flat"), decks, strict=True)}
    found = broken_rules(files, tmp_path / "top.gds", tmp_path / "all.lyrdb")
    assert found == {"nwm space": 1, "nwm width": 1}
    assert not list(tmp_path.glob("deep.lyrdb")) and not list(tmp_path.glob("flat.lyrdb"))


def test_a_deck_without_spaces_is_refused():
    with pytest.raises(StepError, match="no rule of a space"):
        deep_and_flat("deep\nnwm = input(64, 20)\n")


def test_the_comparison_goes_by_cells_and_the_substrate_is_one_net():
    assert hierarchical(LVS, (65, 20)).splitlines()[1:5] == [
        "deep",
        "_wafer = input(65, 20)",
        "substrate__Sky130 = (_wafer-nwm)",
        'connect_global(substrate__Sky130, "SUBSTRATE")',
    ]


@pytest.mark.parametrize("line", ["flat", "_wafer = extent.sized(0.34)", "connect(substrate__Sky130, _wafer)"])
def test_a_deck_that_lacks_a_line_is_refused(line):
    with pytest.raises(StepError, match="the deck has 0 lines like"):
        hierarchical(LVS.replace(line + "\n", ""), (65, 20))
