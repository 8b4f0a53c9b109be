"""Labels of a streamed layout: of a port where it is, not where its net was before it was rerouted."""

import klayout.db as db
import pytest

from talbot.base.steps import StepError
from talbot.flow.layout.geometry.labels import relabel
from talbot.platforms.coriolis import coriolis_platform

pytestmark = pytest.mark.needs("layout")


@pytest.fixture
def routed():
    """As Coriolis writes it, texts on datatype 0: net a is a port, on the west; a second of its labels is on
    nothing; the supplies are strapped."""
    tech, layout = coriolis_platform("sky130"), db.Layout()
    top = layout.create_cell("block")
    for metal, box, texts in (
        (tech.metals[1], (-0.1, 1.0, 3.0, 1.3), [("a", 0.0, 1.15), ("a", 5.0, 8.0)]),
        (tech.metals[2], (0.0, 8.0, 10.0, 8.2), [("n1", 2.0, 8.1)]),
        (tech.metals[-1], (1.0, 0.0, 2.2, 10.0), [("vdd", 1.6, 0.0), ("vdd", 1.6, 5.0)]),
    ):
        top.shapes(layout.layer(*metal.gds)).insert(db.DBox(*box))
        for net, x, y in texts:
            top.shapes(layout.layer(metal.layer, 0)).insert(db.DText(net, x, y))
    # a segment of the port's net, the port itself, a segment that was moved
    for box in ((-0.1, 1.0, 3.0, 1.3), (-0.1, 1.0, 0.1, 1.3), (4.0, 7.9, 6.0, 8.1)):
        top.shapes(layout.layer(68, tech.pin_datatype)).insert(db.DBox(*box))
    return tech, layout


def texts(layout, layer, datatype):
    return sorted(
        (shape.text.string, shape.text.x, shape.text.y)
        for shape in layout.top_cell().shapes(layout.layer(layer, datatype)).each(db.Shapes.STexts)
    )


def test_a_port_is_labelled_where_it_is(routed):
    tech, layout = routed
    relabel(layout, {"a", "vdd"}, tech)
    for datatype in (tech.label_datatype, tech.pin_datatype):
        assert texts(layout, 68, datatype) == [("a", 0, 1150)]
        assert texts(layout, 69, datatype) == []
        assert texts(layout, 71, datatype) == [("vdd", 1600, 0), ("vdd", 1600, 5000)]
    assert texts(layout, 68, 0) == []


def test_of_a_port_only_its_own_place_is_a_pin(routed):
    tech, layout = routed
    relabel(layout, {"a", "vdd"}, tech)
    pins = layout.top_cell().shapes(layout.layer(68, tech.pin_datatype)).each(db.Shapes.SAll - db.Shapes.STexts)
    assert [shape.dbbox() for shape in pins] == [db.DBox(-0.1, 1.0, 0.1, 1.3)]


def test_a_port_without_a_label_is_told(routed):
    tech, layout = routed
    with pytest.raises(StepError, match="ports without a pin in the layout: b"):
        relabel(layout, {"a", "b"}, tech)
