"""All columns keep the rules and are their circuit; faults planted between, over and in columns are found."""

import pytest

from talbot.base.gds import db, write_gds
from talbot.models.parameters import ArrayParameters, ChipParameters
from talbot.pixels.analog_layout.column_amplifiers import draw_column_amplifiers
from talbot.pixels.analog_layout.column_parts import HEIGHT
from talbot.pixels.circuits.column_sizes import ColumnSpec, size
from talbot.pixels.post_layout.checks import differences, drc, lvs
from talbot.pixels.post_layout.test.planted import changed
from talbot.platforms.analog import analog_masks
from talbot.platforms.layout import layout_platform
from talbot.platforms.sky130 import analog as process
from talbot.signoff.geometry.antenna import violations

pytestmark = pytest.mark.needs("layout", "klayout")

MASKS = analog_masks("sky130")
METALS, VIAS = ([one.gds for one in found] for found in (MASKS.base.metals, MASKS.base.vias))


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    path = tmp_path_factory.mktemp("block") / "block.gds"
    made = draw_column_amplifiers(MASKS, size(ColumnSpec.of(), process), ArrayParameters(), ChipParameters())
    write_gds(made.layout, path, made.cell)
    return made, path


def found(block, folder, change=lambda layout, top: None):
    """What LVS finds once ``change`` was made to the block's cells; None: nothing."""
    made, path = block
    bad, report = changed(path, folder / "bad.gds", change), folder / "bad.lvsdb"
    return None if lvs(bad, made.spice(MASKS), "sky130", report, made.boxes) else differences(report)


def over(block, top, mask, number, box):
    """Draw a box above one column; um from that column's corner, as `column_cell` has them."""
    left, low, right, high = box
    height = block[0].block.height_um
    shape = db.DBox(HEIGHT * number + low, height - right, HEIGHT * number + high, height - left)
    top.shapes(top.layout().layer(*mask)).insert(shape)


def halved(cell, mask):
    """The longest line of a cell on a mask is cut in the middle."""
    shapes = cell.shapes(cell.layout().layer(*mask))
    longest = max(shapes.each(), key=lambda one: one.bbox().width())
    box = longest.bbox()
    longest.delete()
    for left, right in ((box.left, box.center().x - 500), (box.center().x + 500, box.right)):
        shapes.insert(db.Box(left, box.bottom, right, box.top))


@pytest.mark.slow
def test_all_columns_keep_the_rules(block, tmp_path):
    assert drc(block[1], "sky130", tmp_path / "good.lyrdb") == {}
    bad = violations(block[0].layout, block[0].cell, layout_platform("sky130"))
    assert not any(one.count() for one in bad.values())  # antennas


def test_all_columns_are_their_circuit_and_one_with_anothers_code_is_not(block, tmp_path):
    assert found(block, tmp_path) is None
    made, path = block
    text = made.spice(MASKS)
    other = text.replace(" group_2 ", " group_3 ", 1)
    assert other != text and not lvs(path, other, "sky130", tmp_path / "other.lvsdb", made.boxes)


def inner(block, net):
    """The first track of a net of a column that is no port."""
    column = block[0].columns.column
    assert net not in column.ports
    return next(track for track in column.tracks if track.net == net)


@pytest.mark.slow
def test_what_reaches_into_a_column_is_found(block, tmp_path):
    track = inner(block, "back_a.x")
    line = next(x for x in sorted(block[0].columns.plan.lines.values()) if track.left + 1 < x < track.right - 1)

    def neighbours(layout, top):
        over(block, top, METALS[3], 10, (track.left, track.y - 0.15, track.left + 0.3, track.y + HEIGHT + 0.15))

    def to_a_line(layout, top):
        over(block, top, VIAS[3], 10, (line - 0.1, track.y - 0.1, line + 0.1, track.y + 0.1))

    def gate(layout, top):
        """Poly over the widest drain."""
        cell = layout.cell("column")
        active, poly = (
            db.Region(cell.begin_shapes_rec(layout.layer(*mask))) for mask in (MASKS.base.active, MASKS.base.poly)
        )
        box = max((active - poly).each(), key=lambda one: one.area()).bbox().to_dtype(layout.dbu)
        x = box.center().x
        over(block, top, MASKS.base.poly, 200, (x - 0.075, box.bottom - 0.2, x + 0.075, box.top + 0.2))

    def well(layout, top):
        top.shapes(layout.layer(*MASKS.base.well)).insert(db.DBox(2000, 80, 2005, 90))

    assert any(name.startswith("column: net") for name in found(block, tmp_path, well))
    assert any(name.startswith("column: pin") for name in found(block, tmp_path, neighbours))
    assert any(name.startswith("column: pin") for name in found(block, tmp_path, to_a_line))
    assert any(name.startswith("column: device") for name in found(block, tmp_path, gate))


@pytest.mark.slow
def test_faults_of_lines_vias_and_supplies_are_found(block, tmp_path):
    plan = block[0].columns.plan

    def lines(layout, top):
        first, last = sorted(plan.lines.values())[20:22]
        over(block, top, METALS[4], 300, (first, 2, last, 2.4))

    def no_via(layout, top):
        next(one for one in layout.cell("columns").each_inst() if one.cell.name == "column_code").delete()

    def supplies(layout, top):
        """The supply's first strap goes on where it makes room for the ground's pin."""
        pin = next(pin for pin in block[0].block.pins if pin.name == "vssa" and pin.side == "west")
        top.shapes(layout.layer(*METALS[5])).insert(db.DBox(2.1, pin.at_um - 20, 2.9, pin.at_um + 20))

    assert found(block, tmp_path, lines) and found(block, tmp_path, no_via) and found(block, tmp_path, supplies)
    assert found(block, tmp_path, lambda layout, top: halved(layout.cell("columns_and_ways"), METALS[2]))
    names = found(block, tmp_path, lambda layout, top: halved(layout.cell("column"), METALS[2]))
    assert any(name.startswith("column: net") for name in names)
