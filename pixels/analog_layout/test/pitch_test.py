"""Rows and columns at any pitch: whole vias, lines at their pins, room for every way, and refused pitches."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.base.gds import db
from talbot.models.parameters import ArrayParameters, ChipParameters, ParameterError
from talbot.pixels.analog_layout.column_amplifiers import OUTWARD, frame
from talbot.pixels.analog_layout.column_band import (
    CROSSING_SPACE,
    PLATES_SPACE,
    RAMP,
    SPARE_WAYS,
    band_devices,
    bank_group,
    bank_rows,
    bias_plates,
)
from talbot.pixels.analog_layout.column_parts import HEIGHT
from talbot.pixels.analog_layout.row_drivers import chip_pin, row_cell
from talbot.pixels.blocks import AnalogSizes, row_lines
from talbot.pixels.circuits.column import BIASES
from talbot.pixels.circuits.column_block import BANK_INPUTS, BANK_OUTPUTS
from talbot.pixels.circuits.column_sizes import ColumnSpec, size
from talbot.pixels.circuits.row_driver import ROW_LINES
from talbot.pixels.drawn import PITCH_STEP_UM, PIXEL_PITCHES_UM, check_pitch
from talbot.platforms.analog import analog_masks
from talbot.platforms.sky130 import analog as process

pytestmark = pytest.mark.needs("layout")

MASKS = analog_masks("sky130")
SIZES = size(ColumnSpec.of(), process)
PAIRS = bank_rows(SIZES, band_devices(SIZES, 1))
SOUTH = {pin.name: pin.at_um for pin in frame(ArrayParameters(8, 384), ChipParameters(), AnalogSizes()).pins}
PINS = {name: SOUTH[chip_pin(name)] for name in BANK_INPUTS}
LANES = min(x for name, x in SOUTH.items() if name.startswith("lane_"))
LINES = len(OUTWARD) - len(BANK_OUTPUTS)  # of the bias, at most
STEPS = st.integers(*(round(um / PITCH_STEP_UM) for um in PIXEL_PITCHES_UM))


@settings(deadline=None)
@given(STEPS)
def test_ways_and_capacitors_have_room_at_any_pitch(steps):
    pitch = round(steps * PITCH_STEP_UM, 2)
    bank = bank_group(PAIRS, pitch, PINS, OUTWARD)
    assert all(abs(bank.inner[RAMP] - x) >= CROSSING_SPACE for x in bank.pins.values())
    ways = [k * pitch for k in range(1, int(bank.right / pitch + 1e-6) + 1) if bank.clear(k * pitch)]
    assert len(ways) >= len(set(OUTWARD) & set(BANK_OUTPUTS)) + SPARE_WAYS
    plates = bias_plates(pitch, bank.right, LANES - 20, LINES)
    assert plates.parts > 0 and bank.right < plates.west
    assert plates.west + plates.pitch * plates.parts * len(BIASES) + PLATES_SPACE <= LANES - 20
    assert plates.pitch == pytest.approx(pitch * round(plates.pitch / pitch))


@pytest.mark.parametrize("pitch", (12.03, 13.5))
def test_a_row_has_whole_vias_and_its_lines_at_the_pins(pitch):
    array = ArrayParameters(1, 384, round(1e-6 * pitch, 12))
    drawn = row_cell(MASKS, array)
    for via in MASKS.base.vias:
        boxes = [
            polygon.bbox() for polygon in db.Region(drawn.cell.begin_shapes_rec(drawn.layout.layer(*via.gds))).each()
        ]
        assert len({(box.width(), box.height()) for box in boxes}) <= 1
        assert all(edge % 5 == 0 for box in boxes for edge in (box.left, box.bottom))
    third = db.Region(drawn.cell.begin_shapes_rec(drawn.layout.layer(*MASKS.base.metals[3].gds))).merged()
    east, places = drawn.cell.dbbox().right, dict(row_lines(array))
    for line in ROW_LINES:
        at = places[f"{line}[0]"]
        assert not (db.Region(db.DBox(east - 1, at - 0.01, east, at + 0.01).to_itype(0.001)) - third).count()
    assert drawn.cell.dbbox().height() == pytest.approx(pitch)


def test_a_pitch_off_the_grid_is_refused_and_the_smallest_holds_a_column():
    with pytest.raises(ParameterError, match="array.pitch_um = 12.005: must be a multiple of 0.01 um"):
        check_pitch(12.005)
    assert PIXEL_PITCHES_UM[0] >= HEIGHT
