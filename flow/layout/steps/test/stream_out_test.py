"""Labels of the streamed layout: of a port where it is, not where wires of its net were before they were moved."""

import pytest

from base.steps import StepError
from flow.layout.steps.stream_out import relabel
from platforms.coriolis import coriolis_platform

db = pytest.importorskip("klayout.db", reason="klayout: not installed; make layout installs it")
RULES = {
    "space_um": {wire: 0.14 for wire in ("li", "m1", "m2", "m3", "m4")},
    "metals": {wire: {"area": 0.0, "space": 0.14} for wire in ("li", "m1", "m2", "m3", "m4")},
}


@pytest.fixture
def routed(tmp_path):
    """As Coriolis writes it, texts on datatype 0: net w0 is the port a, on the west; a second of its labels lies on
    nothing; the supplies are strapped."""
    known, layout = coriolis_platform("sky130"), db.Layout()
    top = layout.create_cell("block")
    for wire, box, texts in (
        (known.metals[1], (-0.1, 1.0, 3.0, 1.3), [("w0", 0.0, 1.15), ("w0", 5.0, 8.0)]),
        (known.metals[2], (0.0, 8.0, 10.0, 8.2), [("w1", 2.0, 8.1)]),
        (known.metals[-1], (1.0, 0.0, 2.2, 10.0), [("vdd", 1.6, 0.0), ("vdd", 1.6, 5.0)]),
    ):
        top.shapes(layout.layer(*wire.gds)).insert(db.DBox(*box))
        for net, x, y in texts:
            top.shapes(layout.layer(wire.layer, 0)).insert(db.DText(net, x, y))
    # a wire of the port's, the port itself, a wire that was moved away
    for box in ((-0.1, 1.0, 3.0, 1.3), (-0.1, 1.0, 0.1, 1.3), (4.0, 7.9, 6.0, 8.1)):
        top.shapes(layout.layer(68, known.pin_datatype)).insert(db.DBox(*box))
    layout.write(str(tmp_path / "routed.gds"))
    return known, tmp_path / "routed.gds"


def texts(path, layer, datatype):
    layout = db.Layout()
    layout.read(str(path))
    return sorted(
        (shape.text.string, shape.text.x, shape.text.y)
        for shape in layout.top_cell().shapes(layout.layer(layer, datatype)).each(db.Shapes.STexts)
    )


def test_a_port_is_labelled_where_it_is(routed, tmp_path):
    known, path = routed
    relabel(path, tmp_path / "out.gds", "Block", {"w0": "a", "w1": "n1"}, {"a", "vdd"}, known, RULES)
    for datatype in (known.label_datatype, known.pin_datatype):
        assert texts(tmp_path / "out.gds", 68, datatype) == [("a", 0, 1150)]
        assert texts(tmp_path / "out.gds", 69, datatype) == []
        assert texts(tmp_path / "out.gds", 71, datatype) == [("vdd", 1600, 0), ("vdd", 1600, 5000)]
    assert texts(tmp_path / "out.gds", 68, 0) == []


def test_of_a_port_only_its_own_place_is_a_pin(routed, tmp_path):
    known, path = routed
    relabel(path, tmp_path / "out.gds", "Block", {"w0": "a", "w1": "n1"}, {"a", "vdd"}, known, RULES)
    layout = db.Layout()
    layout.read(str(tmp_path / "out.gds"))
    pins = layout.top_cell().shapes(layout.layer(68, known.pin_datatype)).each(db.Shapes.SAll - db.Shapes.STexts)
    assert [shape.dbbox() for shape in pins] == [db.DBox(-0.1, 1.0, 0.1, 1.3)]


def test_a_port_without_a_label_is_told(routed, tmp_path):
    known, path = routed
    with pytest.raises(StepError, match="ports without a pin in the layout: b"):
        relabel(path, tmp_path / "out.gds", "Block", {"w0": "a"}, {"a", "b"}, known, RULES)
