"""A layout in a frame: its ports, its place, straps as pins, its LEF."""

import klayout.db as db
import pytest

from talbot.base.lef.read import read_macro
from talbot.base.steps import StepError
from talbot.flow.layout.geometry.abstract import abstract, read_back
from talbot.flow.layout.geometry.floorplan import framed
from talbot.flow.layout.geometry.frame import into_frame, mark_straps
from talbot.flow.layout.netlist.netlist import Netlist, Port, supplies
from talbot.models.parameters import ParameterError
from talbot.platforms.coriolis import coriolis_platform
from talbot.platforms.frame import Frame

pytestmark = pytest.mark.needs("layout")
FRAME = Frame(12.0, 10.0, (1.0, 1.5), (("a", 3.0), ("q", 8.0)), (0.3, 1.0), "met4", ("VPWR", "VGND"))
ORIGIN = 1.0, 2.0
NETLIST = Netlist("Two", (Port("a", "input", 1), Port("q", "output", 1)), ())


@pytest.fixture
def tech():
    return coriolis_platform("sky130")


@pytest.fixture
def plan(tech):
    return framed(FRAME, ORIGIN, NETLIST, tech)


@pytest.fixture
def layout(tech, plan):
    """Of a core of 10 um x 6 um: the ports of ``plan``, a segment from the first, two straps."""
    layout, metal = db.Layout(), tech.metals[-1]
    top = layout.create_cell("Two")
    shapes, pins = (top.shapes(layout.layer(*at)) for at in (metal.gds, metal.pin))
    for net, _, box in plan["ports"]:
        shapes.insert(db.DBox(*box))
        pins.insert(db.DBox(*box))
        pins.insert(db.DText(net, (box[0] + box[2]) / 2, box[1] + 0.5))
    shapes.insert(db.DBox(1.85, 3.0, 2.15, 7.5))
    for net, x in (("VPWR", 4.0), ("VGND", 9.0)):
        shapes.insert(db.DBox(x - 0.6, 0.0, x + 0.6, 6.0))
        pins.insert(db.DText(net, x, 3.0))
    return layout


def test_the_ports_are_at_the_edge_of_the_frame(plan):
    assert plan["frame"] == [-1.0, -2.0, 11.0, 8.0] and supplies(plan) == ("VPWR", "VGND") != supplies({})
    assert plan["ports"] == [["a", "m4", [1.85, 7.0, 2.15, 8.0]], ["q", "m4", [6.85, 7.0, 7.15, 8.0]]]
    assert plan["pins"] == {"north": ["a", "q"]}


def test_other_ports_are_refused(tech):
    with pytest.raises(ParameterError, match="ports = b, q: must be those of the frame"):
        framed(FRAME, ORIGIN, Netlist("Two", (Port("a", "input", 1), Port("b", "output", 1)), ()), tech)


def test_its_lef_has_the_frames_size_and_pins(tech, plan, layout, tmp_path):
    outline = into_frame(layout, plan["frame"])
    mark_straps(layout, FRAME.supplies, tech)
    layout.top_cell().shapes(layout.layer(*tech.outline)).insert(outline)
    layout.write(str(tmp_path / "two.gds"))
    directions = {"a": "input", "q": "output"}
    text = abstract(tmp_path / "two.gds", directions, tech, FRAME.supplies, framed=True)
    (tmp_path / "two.lef").write_text(text)
    macro = read_macro(text)
    assert (macro.width_um, macro.height_um) == (12.0, 10.0)
    boxes = {name: (pin.use, pin.boxes) for name, pin in macro.pins.items()}
    assert boxes == {
        "a": ("SIGNAL", (("met4", (2.85, 9.0, 3.15, 10.0)),)),
        "q": ("SIGNAL", (("met4", (7.85, 9.0, 8.15, 10.0)),)),
        "VPWR": ("POWER", (("met4", (4.4, 2.0, 5.6, 8.0)),)),
        "VGND": ("GROUND", (("met4", (9.4, 2.0, 10.6, 8.0)),)),
    }
    assert read_back(tmp_path / "two.lef", tmp_path / "two.gds", directions, tech, FRAME.supplies) == []


def test_nothing_may_be_outside(plan, layout, tech):
    layout.top_cell().shapes(layout.layer(*tech.metals[1].gds)).insert(db.DBox(10.0, 1.0, 11.005, 1.3))
    with pytest.raises(StepError, match="must be inside the frame"):
        into_frame(layout, plan["frame"])
