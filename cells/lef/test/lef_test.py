"""Abstracts from GDS against SkyWater's own LEF of the same cells."""

import klayout.db as db
import pytest

from talbot.base.lef.read import read_macros
from talbot.cells.lef.abstract import PinKind, abstract
from talbot.models.parameters import ParameterError
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.sky130 import cells

pytestmark = pytest.mark.needs("layout")

needs_wheel = pytest.mark.needs("layout")
TECH = extraction_platform("sky130")
CELLS = ("inv_1", "nand2_1", "a21oi_1", "mux2_1", "dfxtp_1", "dfrtp_1", "fa_1", "buf_4")


def ours(cell, pins):
    name = f"sky130_fd_sc_hd__{cell}"
    return read_macros(abstract(cells.file(cell, "gds"), name, TECH, pins, "unithd"))[name]


def vendor(cell):
    return read_macros(cells.file(cell, "lef").read_text())[f"sky130_fd_sc_hd__{cell}"]


def pins_of(macro):
    return {
        name: PinKind(pin.direction, pin.use)
        for name, pin in macro.pins.items()
        if {layer for layer, _ in pin.boxes} & {"li1", "met1"}
    }


def region(shapes, layer):
    found = db.Region()
    for box in [box for of, box in shapes if of == layer]:
        found.insert(db.Box(*(round(v * 1000) for v in box)))
    return found.merged()


@needs_wheel
@pytest.mark.parametrize("cell", CELLS)
def test_outline_and_pins_are_the_vendors(cell):
    theirs = vendor(cell)
    mine = ours(cell, pins_of(theirs))
    assert (mine.width_um, mine.height_um) == (theirs.width_um, theirs.height_um)
    for name in pins_of(theirs):
        for layer in ("li1", "met1"):
            a, b = (region(pin.boxes, layer) for pin in (mine.pins[name], theirs.pins[name]))
            assert (b - a).is_empty(), f"{name} {layer}: metal of the vendor's pin is missing"
            # the vendor leaves out what is under a gate's contact; never more than a tenth of the pin
            assert (a - b).area() <= 0.1 * max(a.area(), 1), f"{name} {layer}"


@needs_wheel
@pytest.mark.parametrize("cell", CELLS)
def test_antenna_areas_are_the_vendors(cell):
    theirs = vendor(cell)
    mine = ours(cell, pins_of(theirs))
    for name, pin in theirs.pins.items():
        for keyword in ("ANTENNAGATEAREA", "ANTENNADIFFAREA"):
            if pin.use == "SIGNAL" and keyword in pin.antenna:
                area = mine.pins[name].antenna[keyword]
                assert area == pytest.approx(pin.antenna[keyword], abs=0.002), (name, keyword)


@needs_wheel
@pytest.mark.parametrize("cell", ("dfxtp_1", "mux2_1", "fa_1"))
def test_other_nets_are_obstructions(cell):
    theirs = vendor(cell)
    mine = ours(cell, pins_of(theirs))
    for layer in ("li1", "met1"):
        metal = region(theirs.obstructions, layer)
        pins = region([part for pin in mine.pins.values() for part in pin.boxes], layer)
        blocked = region(mine.obstructions, layer)
        assert (blocked & pins).is_empty()
        assert (blocked - metal).area() <= 0.02 * max(blocked.area(), 1)


@needs_wheel
def test_what_is_not_there_is_refused():
    with pytest.raises(ParameterError, match="pin = 'B': must be a labelled net"):
        ours("inv_1", {"B": PinKind("INPUT")})
    with pytest.raises(ParameterError, match="direction = 'IN'"):
        PinKind("IN")
