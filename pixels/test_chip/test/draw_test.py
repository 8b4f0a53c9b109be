"""The drawn test chip: its pixels, its pins against the LEF, its circuit, and faults planted in these."""

from dataclasses import replace
from functools import cache

import pytest

from talbot.base.gds import db
from talbot.models.parameters import TileParameters
from talbot.pixels.test_chip import project
from talbot.pixels.test_chip.checks import lvs, netlist, untied
from talbot.pixels.test_chip.draw import HEIGHT, TIED, WIDTH, TestChip, draw_chip
from talbot.pixels.test_chip.job import write_named
from talbot.pixels.test_chip.places import COLS, ROWS
from talbot.platforms.analog import analog_masks
from talbot.platforms.sky130 import layers

pytestmark = pytest.mark.needs("layout", "klayout")
MASKS = analog_masks("sky130")


@cache
def chip() -> TestChip:
    return draw_chip(MASKS)


def region(made: TestChip, mask: tuple[int, int]) -> db.Region:
    return db.Region(made.cell.begin_shapes_rec(made.layout.layer(*mask))).merged()


def test_all_types_and_both_references_are_selected():
    selected = [chip().pixels[row, col] for row in range(ROWS) for col in range(COLS)]
    assert len(set(selected)) == len(TileParameters().types) + 2
    assert selected.count("pixel_plain") == selected.count("pixel_covered") == 3


def test_the_outline_holds_all_and_the_top_metal_is_free():
    assert chip().cell.dbbox() == db.DBox(0, 0, WIDTH, HEIGHT)
    assert all((info.layer, info.datatype) != layers.MET5.gds for info in chip().layout.layer_infos())


def test_a_covered_well_is_under_metal_and_a_plain_one_is_open():
    upper = region(chip(), layers.MET4.gds) + region(chip(), layers.MET1.gds)
    wells = region(chip(), layers.NWELL)
    for name, covered in (("pixel_covered", True), ("pixel_plain", False)):
        row, col = next(place for place, cell in chip().pixels.items() if cell == name)
        x, y = 2000 + 10_000 + (col + 2) * 10_000, 52_000 + 10_000 + (ROWS + 1 - row) * 10_000
        inside = wells & db.Region(db.Box(x, y, x + 10_000, y + 10_000))
        assert inside.count() == 2
        assert ((inside - upper).area() == 0) is covered


def test_every_pin_of_the_lef_is_metal_and_outputs_are_on_ground():
    metal = region(chip(), layers.MET4.gds)
    pins: dict[str, db.Box] = {}
    name = ""
    for words in map(str.split, project.lef().splitlines()):
        if words[:1] == ["PIN"]:
            name = words[1]
        elif words[:1] == ["RECT"]:
            pins[name] = db.DBox(*map(float, words[1:5])).to_itype(0.001)
    assert len(pins) == 43 + 8 + 3
    assert all((db.Region(box) - metal).is_empty() for box in pins.values())
    bar = metal.interacting(db.Region(pins[TIED[0]]))
    assert bar.count() == 1
    assert all(not (db.Region(pins[name]) & bar).is_empty() for name in TIED)
    assert all((db.Region(box) & bar).is_empty() for name, box in pins.items() if name not in TIED)


def test_the_layout_is_its_circuit_and_another_size_is_found(tmp_path):
    write_named(chip(), tmp_path / "chip.gds")
    text = netlist(chip(), MASKS)
    assert lvs(tmp_path / "chip.gds", text, MASKS, tmp_path / "good.lvsdb")
    first, *others = chip().devices
    wrong = replace(chip(), devices=(replace(first, transistor=first.transistor._replace(w=2.5)), *others))
    assert not lvs(tmp_path / "chip.gds", netlist(wrong, MASKS), MASKS, tmp_path / "size.lvsdb")


def test_an_output_that_is_not_on_ground_is_found():
    made = draw_chip(MASKS)
    assert not untied(made.layout, MASKS)
    shapes = made.cell.shapes(made.layout.layer(*layers.MET4.gds))
    rest = db.Region(shapes) - db.Region(db.Box(14_000, 200_000, 18_000, 205_000))  # from the bar to the rail
    shapes.clear()
    shapes.insert(rest)
    assert untied(made.layout, MASKS) == [*TIED]
