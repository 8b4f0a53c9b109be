"""The wheel's Verilog read as functions, against what the transistors of the same cells do."""

import itertools

import pytest

from talbot.base.liberty.read import parse
from talbot.cells.netlist import spice
from talbot.cells.netlist.function import understand
from talbot.platforms.sky130 import cells
from talbot.platforms.sky130.functions import liberty
from talbot.platforms.sky130.models import POLARITY, SUPPLIES

pytestmark = pytest.mark.needs("layout")

LIBRARY = parse(liberty())


def value(expression, inputs):
    python = expression.replace("!", " not ").replace("&", " and ").replace("|", " or ").replace("^", " != ")
    return bool(eval(python, {}, dict(inputs)))


def group(cell):
    return LIBRARY.one("cell", f"sky130_fd_sc_hd__{cell}")


@pytest.mark.parametrize(
    "cell",
    [
        "inv_1",
        "nand3b_1",
        "nor2b_1",
        "a21boi_0",
        "o221a_1",
        "xor2_1",
        "xnor2_1",
        "mux2_1",
        "mux2i_1",
        "mux4_1",
        "maj3_1",
        "fa_1",
        "and4bb_1",
    ],
)
def test_functions_are_those_of_the_transistors(cell):
    known = understand(spice.read(cells.file(cell, "spice")), POLARITY, SUPPLIES).functions
    found = {pin.name: pin.text("function") for pin in group(cell).all("pin", direction="output")}
    assert found.keys() == known.keys()
    inputs = [pin.name for pin in group(cell).all("pin", direction="input")]
    for bits in itertools.product((False, True), repeat=len(inputs)):
        at = dict(zip(inputs, bits, strict=True))
        assert {pin: value(f, at) for pin, f in found.items()} == {pin: value(f, at) for pin, f in known.items()}, at


def test_areas_are_sizes_of_the_lef():
    assert group("nand2_1").number("area") == 3.7536  # 1.38 by 2.72 um
    assert group("dfxtp_1").number("area") == 20.0192  # 7.36 by 2.72 um
    assert group("dfrtp_1").one("ff").text("clear") == "!RESET_B"


def test_what_synthesis_by_area_must_not_take_is_left_out():
    for cell in ("lpflow_inputiso0n_1", "dlxtp_1", "ebufn_1", "clkdlybuf4s15_1", "conb_1"):
        assert group(cell) is None
