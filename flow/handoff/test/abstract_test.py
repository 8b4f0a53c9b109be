"""The LEF made from a small GDS: size, pins and obstructions, and that KLayout's LEF reader takes it."""

import pytest

from flow.handoff.abstract import abstract, ports
from flow.handoff.lef import pins, size
from flow.platforms.embedded import process
from models.parameters import ParameterError

db = pytest.importorskip("klayout.db", reason="klayout is not installed (make layout)")
NETLIST = "module Two (a, q);\n  input a;\n  output [1:0] q;\nendmodule\n"


@pytest.fixture
def known():
    return process("sky130")[0]


@pytest.fixture
def gds(known, tmp_path):
    """Two rows high, ten sites wide; a on the west, q on the east, supplies on straps, wells that reach farther."""
    layout = db.Layout()
    top = layout.create_cell("Two")
    wire, strap = known.wires[1], known.wires[-1]

    def draw(of, net, box, at):
        top.shapes(layout.layer(of.layer, of.datatype)).insert(db.DBox(*box))
        top.shapes(layout.layer(of.layer, known.pin_datatype)).insert(db.DText(net, *at))

    draw(wire, "a", (-0.1, 1.0, 3.0, 1.3), (2.0, 1.15))
    draw(wire, "q[0]", (5.0, 2.0, 8.1, 2.3), (6.0, 2.15))
    draw(wire, "q[1]", (5.0, 4.0, 8.0, 4.3), (6.0, 4.15))
    draw(wire, "inside", (3.5, 6.0, 4.5, 6.3), (4.0, 6.15))
    draw(strap, "vdd", (1.0, 0.0, 2.2, 11.2), (1.5, 5.0))
    draw(strap, "vss", (4.0, 0.0, 5.2, 11.2), (4.5, 5.0))
    top.shapes(layout.layer(64, 20)).insert(db.DBox(-0.2, 5.6, 8.2, 11.3))
    layout.write(str(tmp_path / "two.gds"))
    return tmp_path / "two.gds"


def test_size_and_pins(gds, known):
    text = abstract(gds, ports(NETLIST), known, {(68, 20): "met1", (71, 20): "met4"})
    assert size(text) == (8.0, 11.2)
    found = {pin.name: pin for pin in pins(text)}
    assert set(found) == {"a", "q[0]", "q[1]", "vdd", "vss"}
    assert (found["a"].x_um, found["a"].y_um, found["a"].layer, found["a"].direction) == (0.15, 1.15, "met1", "INPUT")
    assert (found["q[1]"].x_um, found["q[1]"].y_um, found["q[1]"].direction) == (7.85, 4.15, "OUTPUT")
    assert (found["vdd"].x_um, found["vdd"].y_um, found["vdd"].layer, found["vdd"].use) == (1.6, 5.6, "met4", "POWER")


def test_obstructions_cover_all_but_the_pins(gds, known, tmp_path):
    (tmp_path / "two.lef").write_text(abstract(gds, ports(NETLIST), known, {}))
    layout = db.Layout()
    layout.read(str(tmp_path / "two.lef"))
    areas = {}
    for info in layout.layer_infos():
        areas[info.name] = db.Region(layout.top_cell().shapes(layout.layer(info))).merged()
    obstructed, pin = areas["m1.OBS"], areas["m1.PIN"]
    assert (obstructed & pin.sized(300)).is_empty()
    assert obstructed.area() > 0.9 * 8000 * 11200
    assert areas["li.OBS"].area() == 8000 * 11200


def test_a_port_without_metal_is_named(gds, known):
    with pytest.raises(ParameterError, match="must have metal for the pins lost"):
        abstract(gds, ports(NETLIST) | {"lost": "input"}, known, {})
