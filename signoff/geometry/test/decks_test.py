"""What is changed of PDKMaster's decks, and a deck that cannot be changed so."""

import itertools

import numpy as np
import pytest

from talbot.base.gds import db, write_gds
from talbot.base.steps import StepError
from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.decks import broken_rules, deep_and_flat, run_deck, via_rules, violations
from talbot.signoff.geometry.lvs_deck import hierarchical

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
space4width_check(nwm, 1.5, 2.0).output(
    "nwm wide", "nwm space of wide"
)
via = input(68, 44)
width_check(via, 0.15).output(
    "via width", "via that has another width"
)
via.space(0.17).output(
    "via space", "via minimum space"
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
    deep, flat = deep_and_flat(f"source(x)\n{DRC}", ["deeper"], ["more"])
    assert deep.endswith("\ndeeper\n") and deep.startswith("source(x)\ndeep\nnwm = ")
    assert "nwm.space" not in deep and "both.space(0.2)" in deep and "nwm.width" in deep and "via.space" in deep
    spaces = 'nwm = input(64, 20)\nnwm.edges.space(1.27).output(\n    "nwm space", "nwm minimum space"\n)\n'
    wide = 'space4width_check(nwm, 1.5, 2.0).output(\n    "nwm wide", "nwm space of wide"\n)\n'
    assert flat == f"source(x)\nflat\n{spaces}\n{wide}\nmore\n"


def broken_vias(folder, layout, mode):
    """Violations of the vias' rules in a layout, flat or deep."""
    write_gds(layout, folder / "top.gds")
    head = f"source('{folder}/top.gds')\nreport('vias', '{folder}/found.lyrdb')"
    (folder / "vias.drc").write_text("\n".join([head, mode, *via_rules(layout_platform("sky130")), ""]))
    run_deck(folder / "vias.drc", folder / "found.lyrdb", {})
    return violations(folder / "found.lyrdb")


@pytest.mark.needs("klayout")
@pytest.mark.parametrize(
    "cases, found",
    (
        ([(500, [200]), (800, [200, 600])], {}),
        ([(350, [200]), (200, [200]), (800, [200, 335])], {"via3 outside m4": 2, "via3 size": 1}),  # two vias are one
    ),
)
@pytest.mark.parametrize("mode", ("flat", "deep"))
def test_a_via_outside_its_metal_or_of_another_size_is_found(tmp_path, cases, found, mode):
    """Cases, side by side: height of the upper metal, and where vias begin."""
    tech, layout = layout_platform("sky130"), db.Layout()
    top = layout.create_cell("top")
    for x, (end, vias) in enumerate(cases):
        shapes = (tech.metals[3].gds, (0, 0, 500, 800)), (tech.metals[4].gds, (0, 0, 500, end))
        for at, box in (*shapes, *((tech.vias[3].gds, (150, low, 350, low + 200)) for low in vias)):
            top.shapes(layout.layer(*at)).insert(db.Box(*box).moved(5000 * x, 0))
    assert broken_vias(tmp_path, layout, mode) == found


@pytest.mark.needs("klayout")
@pytest.mark.parametrize("mode", ("flat", "deep"))
def test_a_via_with_a_notch_is_of_another_size(tmp_path, mode):
    tech, layout = layout_platform("sky130"), db.Layout()
    top, via = layout.create_cell("top"), tech.vias[3]
    shapes = top.shapes(layout.layer(*via.gds))
    for box in ((0, 0, 200, 120), (0, 120, 120, 200), (1000, 0, 1200, 200)):
        shapes.insert(db.Box(*box))
    for metal in tech.metals[3:5]:
        top.shapes(layout.layer(*metal.gds)).insert(db.Box(-100, -100, 1300, 300))
    assert broken_vias(tmp_path, layout, mode) == {"via3 size": 1}


@pytest.mark.needs("klayout")
def test_decks_run_at_once_and_their_violations_are_in_one_report(tmp_path):
    layout = db.Layout()
    top = layout.create_cell("top")
    for x, width in ((0, 1000), (2000, 800), (5000, 900)):  # a space of 1 um, a width of 0.8
        top.shapes(layout.layer(64, 20)).insert(db.Box(x, 0, x + width, 2000))
    write_gds(layout, tmp_path / "top.gds")
    checks = (f"def {name}(*ask)\n  input(1, 0)\nend\n" for name in ("space4width_check", "width_check"))
    head = "".join(['source(ENV["SOURCE_FILE"])\nreport("r", ENV["REPORT_FILE"])\n', *checks])
    decks = deep_and_flat(head + DRC.replace("(nwm&li)", "nwm & nwm"))
    files = {tmp_path / f"{name}.drc": deck for name, deck in zip(("deep", "flat"), decks, strict=True)}
    found = broken_rules(files, tmp_path / "top.gds", tmp_path / "all.lyrdb")
    assert found == {"nwm space": 1, "nwm width": 1}
    assert not list(tmp_path.glob("deep.lyrdb")) and not list(tmp_path.glob("flat.lyrdb"))


def vias_in_metal(seed):
    """A layout of vias, each in metal on one level that is one rectangle, or two that cross, by any enclosure."""
    random, tech, layout = np.random.default_rng(seed), layout_platform("sky130"), db.Layout()
    top, at = layout.create_cell("top"), itertools.product(range(0, 200_000, 4000), repeat=2)
    pairs = [((66, 44), 170, metal) for metal in ((65, 20), (66, 20), (67, 20))]
    for level, via in enumerate(tech.vias):
        pairs += [(via.gds, round(1000 * via.size_um), metal.gds) for metal in tech.metals[level : level + 2]]
    for via, size, metal in pairs:
        for _ in range(200):
            cell = layout.create_cell("case")
            cell.shapes(layout.layer(*via)).insert(db.Box(0, 0, size, size))
            for left, bottom, right, above in (5 * random.integers(-5, 25, (random.integers(1, 3), 4))).tolist():
                cell.shapes(layout.layer(*metal)).insert(db.Box(-left, -bottom, size + right, size + above))
            top.insert(db.CellInstArray(cell.cell_index(), db.Trans(*next(at))))
    return layout


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.needs("layout")
@pytest.mark.needs("klayout")
@pytest.mark.parametrize("seed", (1, 2))
def test_doubts_change_no_verdict_on_an_enclosure(tmp_path, seed):
    from talbot.platforms.decks import export_decks

    tech = layout_platform("sky130")
    deck = export_decks(tech)["drc"]
    write_gds(vias_in_metal(seed), tmp_path / "top.gds")
    decks = {"all": deck, "deep": deep_and_flat(deck)[0]}
    assert "doubtful" in decks["deep"]
    found = {
        name: broken_rules({tmp_path / f"{name}.drc": text}, tmp_path / "top.gds", tmp_path / f"{name}.lyrdb")
        for name, text in decks.items()
    }
    broken, kept = ({rule: n for rule, n in one.items() if "enclosure" in rule} for one in found.values())
    assert kept == broken and len(broken) >= 8 and min(broken.values()) > 5


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
