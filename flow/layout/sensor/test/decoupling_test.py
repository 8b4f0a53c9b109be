"""Capacitors between the supplies: where there is room, as many as the plan says; their plates short no net."""

import json

import pytest

from talbot.base.gds import db, read_gds
from talbot.flow.layout.sensor import decoupling
from talbot.flow.layout.sensor.plan import Block, DieParameters
from talbot.flow.layout.sensor.test import small
from talbot.platforms.pads import pad_process

pytestmark = pytest.mark.needs("layout")

DIE = DieParameters(3000.0, 1800.0, side_um=91.0, west=2)
BLOCKS = {
    "adc_lanes": Block("adc_lanes", "adc_lanes", 400_000, 300_000, 200_000, 300_000, {}, {}),
    "column_amplifiers": Block("column_amplifiers", "column_amplifiers", 400_000, 600_000, 1_000_000, 100_000, {}, {}),
}


def test_columns_leave_room_for_branches():
    found = decoupling.field(BLOCKS, [], DIE)
    assert found.columns[0] == 620_000 and found.bottom == 320_000 and found.plates == 260 // 34
    end = 3000 - 203 - 10 - 6 * 30 - 20
    assert end - 72 < found.columns[-1] / 1000 + 38 <= end
    some = decoupling.field(BLOCKS, [700_000], DIE)
    assert set(found.columns) - set(some.columns) == {692_000}
    assert decoupling.field(BLOCKS | {"adc_lanes": BLOCKS["column_amplifiers"]}, [], DIE).plates == 0


def test_capacitance_by_hand():
    found = decoupling.Field([0, 72_000], 0, 3)
    assert decoupling.picofarad(found, pad_process("sky130").capacitor) == pytest.approx(
        6 * (2.0 * 900 + 0.19 * 120) / 1000
    )


def test_plates_are_drawn_and_no_net_is_shorted(tmp_path):
    given = small.files(tmp_path)
    metrics = small.plan(given, tmp_path, DIE)
    own = json.loads(given["die_plan.plan"].read_text())["decoupling"]
    count = len(own["columns"]) * own["plates"]
    assert count > 30 and metrics["decoupling_pf"] == pytest.approx(1.8228 * count, abs=0.1)
    assert small.connectivity(given, tmp_path)["lvs_match"]
    layout = read_gds(given["die_gds.gds"])
    plates = db.Region(layout.top_cell().begin_shapes_rec(layout.layer(*pad_process("sky130").capacitor.plate)))
    assert plates.count() == count
    metal = {level: db.Region(layout.top_cell().begin_shapes_rec(layout.layer(level, 20))) for level in (70, 71)}
    assert (plates - metal[70].sized(-140)).is_empty()
    vias = db.Region(layout.top_cell().begin_shapes_rec(layout.layer(70, 44))) & plates
    assert vias.count() > 40 * count and (vias - metal[71]).is_empty()
    for cell in layout.each_cell():  # without their plates the vias reach the ground's metal
        cell.clear(layout.layer(*pad_process("sky130").capacitor.plate))
    layout.write(str(tmp_path / "bare.gds"))
    given["die_gds.gds"] = tmp_path / "bare.gds"
    assert small.run(small.DieConnectivity(small.PdkParameters()), given, tmp_path)["shorts"] == 1
