"""The pins of the analog blocks are those of their real-number model and of the chip; footprints are as described."""

import re
from pathlib import Path

import pytest

from talbot.base.command import main
from talbot.base.gds import db
from talbot.base.lef.read import read_macro
from talbot.models.parameters import ArrayParameters, ChipParameters, ParameterError
from talbot.pixels import footprints
from talbot.pixels.blocks import CIRCUIT_SUPPLIES, PIXEL_SUPPLIES, ROW_PHASES, ROW_SUPPLIES, AnalogSizes, blocks

AFE = Path(__file__).parents[1] / "afe.sv"
OWN_SUPPLIES = {"pixel_array": PIXEL_SUPPLIES, "row_driver": ROW_SUPPLIES}
SMALL = ArrayParameters(8, 100), ChipParameters(2), AnalogSizes(chip_um=100.0)


def widths(names):
    """Port -> bits, of pins as 'a' and 'a[3]'."""
    found = {}
    for name in names:
        base, _, bit = name.partition("[")
        found[base] = max(found.get(base, 1), int(bit.rstrip("]") or 0) + 1 if bit else 1)
    return found


def outer(block):
    """Pins of a block that lead to the chip: in the south, but for those to another analog block."""
    return {
        pin.name: pin.direction
        for pin in block.pins
        if pin.side == "south" and not pin.name.startswith(("column_", "lane_"))
    }


def test_converters_and_columns_have_the_ports_of_their_real_number_model():
    _, driver, columns, lanes = blocks()
    text = AFE.read_text()
    head = text[text.index(") (") : text.index(");")]
    ports = {
        name: {
            "[1:0]": 2,
            "[9:0]": 10,
            "[7:0]": 8,
            "[2:0]": 3,
            "[LANES-1:0]": 8,
            "[`BALANCE_BITS-1:0]": 10,
            "[8*LANES-1:0]": 64,
            "": 1,
        }[bits or ""]
        for bits, name in re.findall(r"(?:input|output)\s+wire\s+(?:signed\s+)?(\[\S+\])?\s*(\w+)", head)
    }
    pins = widths(outer(columns) | outer(lanes))
    phases = {"ref_ctl": 1, "cm_reset": 1, "sample": 1, "read": 1, "tap": 2}
    phases |= {"wake": 1, "convert": 1}  # of energy and time alone
    assert len(ports) == 12 and pins == ports | phases
    assert widths(outer(driver)) == {"amp_row": 10, "reset_row": 10, "expose": 1, "ref_ctl": 1} | ROW_PHASES
    assert {name for name, way in outer(lanes).items() if way == "output"} == {f"comparator[{k}]" for k in range(8)}


def test_lines_that_two_blocks_share_are_at_the_same_place():
    array, driver, columns, lanes = blocks(*SMALL)
    for one, side, other, opposite in ((array, "west", driver, "east"), (array, "south", columns, "north")):
        there = {pin.name: pin.at_um for pin in one.pins if pin.side == side and not pin.supply}
        assert there and there == {pin.name: pin.at_um for pin in other.pins if pin.side == opposite and not pin.supply}
    down, up = (
        {pin.name: pin.at_um for pin in block.pins if pin.name.startswith("lane_")} for block in (columns, lanes)
    )
    assert len(up) == 4 and len({round(down[name] - up[name], 6) for name in up}) == 1
    rows = {pin.name: pin.at_um for pin in array.pins if pin.name.startswith("read_row")}
    assert rows["read_row[0]"] - rows["read_row[7]"] == pytest.approx(70)


@pytest.mark.needs("layout")
def test_footprints_read_back(tmp_path):
    assert main(footprints, ["--rows", "8", "--cols", "90", "--lanes", "2", "--out", str(tmp_path)]) == 2  # no room
    assert main(footprints, ["--rows", "8", "--out", str(tmp_path)]) == 0
    for block in blocks(ArrayParameters(rows=8)):
        macro = read_macro((tmp_path / f"{block.name}.lef").read_text())
        size, pins = (macro.width_um, macro.height_um), macro.pins
        assert macro.name == block.name and size == pytest.approx((block.width_um, block.height_um))
        assert {name: pin.direction.lower() for name, pin in pins.items()} == {
            pin.name: pin.direction for pin in block.pins
        }
        own = OWN_SUPPLIES.get(block.name, CIRCUIT_SUPPLIES)
        assert {name for name, pin in pins.items() if pin.use != "SIGNAL"} == set(own)
        layout = db.Layout()
        layout.read(str(tmp_path / f"{block.name}.gds"))
        (cell,) = layout.top_cells()
        assert cell.name == block.name and cell.dbbox() == db.DBox(0, 0, block.width_um, block.height_um)
        drawn = (
            db.Region(cell.begin_shapes_rec(layout.layer(71, 20)))
            + db.Region(cell.begin_shapes_rec(layout.layer(70, 20)))
            + db.Region(cell.begin_shapes_rec(layout.layer(72, 20)))
        )
        asked = db.Region([db.DBox(*box).to_itype(layout.dbu) for pin in pins.values() for _, box in pin.boxes])
        assert (drawn ^ asked).is_empty() and drawn.count() == len(block.pins)  # none touches another


@pytest.mark.parametrize(
    "given, words",
    [({"lane_um": 5}, "lane_um = 5: must be a number in"), ({"supply_um": float("nan")}, "supply_um = nan: must be")],
)
def test_sizes_out_of_range(given, words):
    with pytest.raises(ParameterError, match=re.escape(words)):
        AnalogSizes(**given)


def test_pins_without_room():
    with pytest.raises(ParameterError, match="cols = 20: 200 um must have room for pins"):
        blocks(ArrayParameters(8, 20))
    with pytest.raises(ParameterError, match="row_driver = 20 um wide: must have 1.5 um for each of its 28 pins"):
        blocks(sizes=AnalogSizes(row_driver_um=20))
