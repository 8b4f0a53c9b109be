"""The LEF made from a small GDS: size, pins and obstructions, and that KLayout's LEF reader takes it."""

from dataclasses import replace

import klayout.db as db
import pytest

from talbot.base.lef.read import read_macro
from talbot.models.parameters import ParameterError
from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.abstract import abstract, ports, read_back

pytestmark = pytest.mark.needs("layout")
NETLIST = "module Two (a, q);\n  input a;\n  output [1:0] q;\nendmodule\n"


@pytest.fixture
def tech():
    return replace(layout_platform("sky130"), row_um=5.6, site_um=0.8, rail=0)


@pytest.fixture
def gds(tech, tmp_path):
    """Two rows high, ten sites wide; a on the west, q on the east, supplies on straps, wells that reach farther."""
    layout = db.Layout()
    top = layout.create_cell("Two")
    metal, strap = tech.metals[1], tech.metals[-1]

    def draw(of, net, box, at):
        top.shapes(layout.layer(*of.gds)).insert(db.DBox(*box))
        top.shapes(layout.layer(*of.pin)).insert(db.DText(net, *at))

    draw(metal, "a", (-0.1, 1.0, 3.0, 1.3), (2.0, 1.15))
    draw(metal, "q[0]", (5.0, 2.0, 8.1, 2.3), (6.0, 2.15))
    draw(metal, "q[1]", (5.0, 4.0, 8.0, 4.3), (6.0, 4.15))
    draw(metal, "inside", (3.5, 6.0, 4.5, 6.3), (4.0, 6.15))
    draw(strap, "vdd", (1.0, 0.0, 2.2, 11.2), (1.5, 5.0))
    draw(strap, "vss", (4.0, 0.0, 5.2, 11.2), (4.5, 5.0))
    top.shapes(layout.layer(64, 20)).insert(db.DBox(-0.2, 5.6, 8.2, 11.3))
    layout.write(str(tmp_path / "two.gds"))
    return tmp_path / "two.gds"


def test_size_and_pins(gds, tech):
    text = abstract(gds, ports(NETLIST), tech)
    macro = read_macro(text)
    found = macro.pins
    assert (macro.width_um, macro.height_um) == (8.0, 11.2)
    assert set(found) == {"a", "q[0]", "q[1]", "vdd", "vss"}
    assert (found["a"].x_um, found["a"].y_um, found["a"].layer, found["a"].direction) == (0.15, 1.15, "met1", "INPUT")
    assert (found["q[1]"].x_um, found["q[1]"].y_um, found["q[1]"].direction) == (7.85, 4.15, "OUTPUT")
    assert (found["vdd"].x_um, found["vdd"].y_um, found["vdd"].layer, found["vdd"].use) == (1.6, 5.6, "met4", "POWER")


def test_a_pin_that_is_an_l_has_a_box_for_each_arm(gds, tech, tmp_path):
    layout, metal = db.Layout(), tech.metals[1]
    layout.read(str(gds))
    layout.top_cell().shapes(layout.layer(*metal.gds)).insert(db.DBox(-0.1, 1.0, 0.2, 2.0))
    layout.write(str(tmp_path / "bent.gds"))
    (tmp_path / "bent.lef").write_text(abstract(tmp_path / "bent.gds", ports(NETLIST), tech))
    assert read_back(tmp_path / "bent.lef", tmp_path / "bent.gds", ports(NETLIST), tech) == []
    pin = read_macro((tmp_path / "bent.lef").read_text()).pins["a"]
    assert sorted(box for _, box in pin.boxes) == [(0.0, 1.0, 0.3, 1.3), (0.0, 1.3, 0.2, 2.0)]


def test_obstructions_cover_all_but_the_pins(gds, tech, tmp_path):
    (tmp_path / "two.lef").write_text(abstract(gds, ports(NETLIST), tech))
    layout = db.Layout()
    layout.read(str(tmp_path / "two.lef"))
    areas = {}
    for info in layout.layer_infos():
        areas[info.name] = db.Region(layout.top_cell().shapes(layout.layer(info))).merged()
    obstructed, pin = areas["met1.OBS"], areas["met1.PIN"]
    assert (obstructed & pin.sized(300)).is_empty()
    assert obstructed.area() > 0.9 * 8000 * 11200
    assert areas["li1.OBS"].area() == 8000 * 11200


def test_a_port_without_metal_is_named(gds, tech):
    with pytest.raises(ParameterError, match="must have metal for the pins lost"):
        abstract(gds, ports(NETLIST) | {"lost": "input"}, tech)


def test_what_a_pin_bears_is_what_its_net_has(gds, tech):
    layout = db.Layout()
    layout.read(str(gds))
    top = layout.top_cell()
    (li, m1), mcon = tech.metals[:2], tech.vias[0]
    for layer, *box in (
        (tech.active, 1.0, 0.4, 2.0, 0.9),
        (tech.poly, 1.4, 0.2, 1.6, 1.4),
        (tech.contact, 1.45, 1.1, 1.55, 1.2),
        (li.gds, 1.3, 1.0, 1.7, 1.4),
        (mcon.gds, 1.45, 1.1, 1.55, 1.2),
    ):
        top.shapes(layout.layer(*layer)).insert(db.DBox(*box))
    layout.write(str(gds))
    pin = abstract(gds, ports(NETLIST), tech).partition("PIN a")[2].partition("END a")[0]
    assert "ANTENNAGATEAREA 0.1000 ;" in pin  # 0.2 x 0.5 um2
    assert f"ANTENNAPARTIALMETALSIDEAREA {2 * (3.1 + 0.3) * m1.thickness_um:.4f} LAYER met1 ;" in pin
    assert f"ANTENNAPARTIALMETALSIDEAREA {4 * 0.4 * li.thickness_um:.4f} LAYER li1 ;" in pin
    assert "ANTENNADIFFAREA" not in pin


def test_an_abstract_that_differs_is_found(gds, tech, tmp_path):
    lef = tmp_path / "two.lef"
    directions, text = ports(NETLIST), abstract(gds, ports(NETLIST), tech)
    lef.write_text(text)
    assert read_back(lef, gds, directions, tech) == []
    lef.write_text(text.replace("0.000 1.000 0.300 1.300", "0.000 3.000 0.300 3.300"))
    assert read_back(lef, gds, directions, tech)[0] == "met1: a pin where there is no metal"
    lef.write_text(text.partition("  OBS")[0] + "END Two\nEND LIBRARY\n")
    assert "met1: metal that is neither pin nor obstruction" in read_back(lef, gds, directions, tech)
    lef.write_text(text.replace("PIN a\n", "PIN b\n").replace("END a\n", "END b\n"))
    assert read_back(lef, gds, directions, tech) == ["pins that differ: a, b"]
