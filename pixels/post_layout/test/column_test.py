"""A drawn column keeps the rules and is its circuit; faults planted in capacitors, lines and devices are found."""

from dataclasses import replace

import pytest

from talbot.base.gds import db, write_gds
from talbot.models.parameters import ChipParameters
from talbot.pixels.analog_layout import column_plan
from talbot.pixels.analog_layout.column import column_cell
from talbot.pixels.analog_layout.column_band import draw_band
from talbot.pixels.circuits.column import TAPS
from talbot.pixels.circuits.column_block import BANK_INPUTS, BANK_OUTPUTS
from talbot.pixels.circuits.column_sizes import ColumnSpec, size
from talbot.pixels.post_layout.checks import drc, lvs
from talbot.pixels.post_layout.extract import extract
from talbot.pixels.post_layout.test.planted import changed
from talbot.platforms.analog import analog_masks
from talbot.platforms.layout import layout_platform
from talbot.platforms.sky130 import analog as process
from talbot.signoff.geometry.antenna import violations

pytestmark = pytest.mark.needs("layout", "klayout")

MASKS = analog_masks("sky130")
SIZES = size(ColumnSpec.of(), process)


@pytest.fixture(scope="module")
def column(tmp_path_factory):
    path = tmp_path_factory.mktemp("column") / "column.gds"
    made = column_cell(MASKS, SIZES)
    made.write(path)
    return made, path


def test_a_column_keeps_the_rules_and_faults_are_found(column, tmp_path):
    _, path = column
    assert drc(path, "sky130", tmp_path / "good.lyrdb") == {}

    def faults(layout, top):
        """An upper plate reaches beyond its lower one."""
        mim = layout.layer(*MASKS.mim)
        box = db.Region(top.shapes(mim)).bbox()
        top.shapes(mim).insert(db.Box(box.right - 500, box.bottom, box.right + 500, box.top))
        metal = layout.layer(*MASKS.base.metals[3].gds)  # of another net, 1.19 um from a lower plate's end
        top.shapes(metal).insert(db.Box(box.left - 1730, box.bottom, box.left - 1330, box.bottom + 1000))

    assert {"capm.3", "capm.2b_a"} <= drc(
        changed(path, tmp_path / "bad.gds", faults), "sky130", tmp_path / "bad.lyrdb"
    ).keys()


def test_a_column_is_its_circuit_and_faults_are_found(column, tmp_path):
    made, path = column
    text = made.spice(MASKS)
    assert lvs(path, text, "sky130", tmp_path / "good.lvsdb")
    assert "Cback_a.tap2.hold" in text
    swapped = text.replace("Cback_a.tap2.hold back_a.tap2.inner", "Cback_a.tap2.hold back_a.tap1.inner")
    assert swapped != text and not lvs(path, swapped, "sky130", tmp_path / "swapped.lvsdb")

    def cut(layout, top):
        """The first line of the second metal under the plates is gone."""
        metal = layout.layer(*MASKS.base.metals[2].gds)
        lines = db.Region(top.shapes(metal))
        longest = max(lines.each(), key=lambda shape: shape.bbox().width()).bbox()
        top.clear(metal)
        top.shapes(metal).insert(
            lines - db.Region(db.Box(longest.left + 900, longest.bottom, longest.right - 900, longest.top))
        )

    assert not lvs(changed(path, tmp_path / "cut.gds", cut), text, "sky130", tmp_path / "cut.lvsdb")


def test_what_a_sample_depends_on_is_apart_from_what_it_must_not(column):
    """F between nets: 0.04 fF of an output to the other diode's line, of 31 fF, is half an LSB of its light."""
    _, nets = extract(column[0], MASKS, layout_platform("sky130").wires["typ"], resistance=False)
    most = {("column_b", "out_a"): 0.02, ("column_a", "out_b"): 0.025, ("cin_a", "out_b"): 0.15}
    most |= {("back_b.above", "cin_a"): 0.02, ("back_b.tap0.inner", "cin_a"): 0.15}
    most |= {(f"back_{d}.f", f"back_{d}.x"): 0.5 for d in "ab"}
    most |= {(f"back_a.tap{t}.inner", "back_a.x"): 0.6 for t in range(TAPS)}
    assert all(pair[0] < pair[1] for pair in most)  # as the pairs of nets are
    assert {pair for pair, limit in most.items() if nets.couplings.get(pair, 0.0) > limit * 1e-15} == set()


def test_no_net_of_a_column_has_an_antenna(monkeypatch):
    """The two gates of clear bear some 50 um of the third metal: a line as long as the strip was too much."""

    def antennas(made):
        found = violations(made.layout, made.cell, layout_platform("sky130"))
        return [level for level, bad in found.items() if bad.count()]

    assert antennas(column_cell(MASKS, SIZES)) == []
    piece = column_plan.PIECES[0]
    longer = replace(piece, over=piece.over | {"clear": "cn"})
    monkeypatch.setattr(column_plan, "PIECES", (longer, *column_plan.PIECES[1:]))
    assert antennas(column_cell(MASKS, SIZES)) == [3]


@pytest.mark.slow
def test_the_band_keeps_the_rules(tmp_path):
    layout = db.Layout()
    layout.dbu = 0.001
    pins = {name: 5 + 4.0 * k for k, name in enumerate(BANK_INPUTS)} | {"ibias": 700.0}
    pins |= {f"lane_{d}{n}": 984 + 100 * n + 33 * (1 + "ab".index(d)) for n in range(8) for d in "ab"}
    lanes = [name for name in pins if name.startswith("lane_")]
    outward = (*BANK_OUTPUTS, "vbp", "vcp", "vcn", "vbl", "level", "reference", "dark", *lanes)
    made = draw_band(layout, MASKS, SIZES, 10.0, ChipParameters().lanes, pins, outward)
    write_gds(layout, tmp_path / "band.gds", made.cell.cell)
    assert drc(tmp_path / "band.gds", "sky130", tmp_path / "band.lyrdb") == {}
