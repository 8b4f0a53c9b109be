"""A planted GDS of two cells, a routed net and fill: what of it is the net's, and errors of a layout that differs."""

import json

import numpy as np
import pytest

from talbot.base.gds import db
from talbot.base.steps import StepError
from talbot.signoff.netlist.netlist import Instance, Netlist, Port
from talbot.signoff.parasitics.capacitance import capacitances
from talbot.signoff.parasitics.extract import extract
from talbot.signoff.parasitics.shapes import shapes
from talbot.signoff.parasitics.spef import spef
from talbot.signoff.parasitics.test.planted import CONTACT, DEVICES, LI, M1, M2, POLY, TECH, VIA, draw, net

MCON = TECH.vias[0].gds
CORNERS = [TECH.wires[name] for name in ("typ", "min", "max")]
NETLIST = Netlist(
    "Top",
    (Port("a", "input", 1), Port("y", "output", 1)),
    (Instance("u0", "inv", {"i": "a", "nq": "w"}), Instance("u1", "inv", {"i": "w", "nq": "y"})),
)
PLACES = [[0, "inv", 0.0, 0.0, "0"], [1, "inv", 20.0, 0.0, "0"]]
GATE = (POLY, 0.9, 0.2, 1.1, 3.0), (CONTACT, 0.92, 1.42, 1.08, 1.58)
INPUT, OUTPUT = (LI, 0.8, 1.2, 1.2, 1.8), (LI, 2.0, 1.2, 2.4, 1.8)


def cut(x):
    """A contact and a via at the middle of a pin, with their metal."""
    y = 1.5
    box = x - 0.085, y - 0.085, x + 0.085, y + 0.085
    pad = x - 0.16, y - 0.16, x + 0.16, y + 0.16
    return (MCON, *box), (M1, *pad), (VIA, *box), (M2, *pad)


ROUTE = (*cut(2.2), (M2, 2.2, 1.4, 21.0, 1.6), *cut(21.0))


def top(*boxes, places=PLACES):
    made = db.Layout()
    made.dbu = 0.001
    inv, cell = made.create_cell("inv"), made.create_cell("Top")
    draw(made, inv, *GATE, INPUT, OUTPUT)
    texts = [(inv, "i", 1.0, 1.5), (inv, "nq", 2.2, 1.5), (cell, "a", 1.0, 1.5), (cell, "y", 22.2, 1.5)]
    for owner, name, x, y in texts:
        owner.shapes(made.layer(*TECH.metals[0].pin)).insert(db.DText(name, x, y))
    for _, _, x, y, _ in places:
        cell.insert(db.DCellInstArray(inv.cell_index(), db.DTrans(db.DVector(x, y))))
    draw(made, cell, *boxes)
    return made


def nets(folder, made, places=PLACES, corners=CORNERS[:1]):
    (folder / "placement.json").write_text(json.dumps({"instances": places}))
    return list(extract(made, NETLIST, folder / "placement.json", TECH, DEVICES, corners))


def test_a_net_has_what_the_layout_adds_to_its_cells(tmp_path):
    made = top(*ROUTE)
    (found,) = nets(tmp_path, made)
    flat = shapes(made, made.cell("Top"), TECH, DEVICES)
    alone = shapes(made, made.cell("inv"), TECH, DEVICES)
    whole, inside = (np.bincount(s.nets, capacitances(s, CORNERS[:1])[0].own) for s in (flat, alone))
    pins = inside[net(alone, "li1", 1.0, 1.5)] + inside[net(alone, "li1", 2.2, 1.5)]
    assert found["w"].femtofarad == pytest.approx(whole[net(flat, "met2", 10, 1.5)] - pins)
    assert 0 < found["a"].femtofarad < 0.01  # nothing outside of its cell but the route nearby
    assert sum(found["w"].nodes.values()) == pytest.approx(found["w"].femtofarad)
    ohms = CORNERS[0].ohms
    (resistor,) = found["w"].resistors
    assert resistor[:2] == (("u0", "nq"), ("u1", "i"))
    # two pads are wider than the line
    assert resistor[2] == pytest.approx(2 * (ohms["mcon"] + ohms["via"]) + 18.8 / 0.2 * ohms["met2"], rel=0.02)


def test_metal_beside_over_and_of_the_fill_adds(tmp_path):
    bare = nets(tmp_path, top(*ROUTE))[0]["w"].femtofarad
    gate = (POLY, 5, 2.5, 5.4, 2.9), (CONTACT, 5.1, 2.6, 5.27, 2.77), (LI, 5, 2.5, 5.4, 2.9)
    neighbour = *gate, (MCON, 5.1, 2.6, 5.27, 2.77), (M1, 5, 2.5, 5.4, 2.9), (VIA, 5.1, 2.6, 5.25, 2.75)
    for more in (
        [*neighbour, (M2, 5, 1.9, 15, 2.9)],
        [(TECH.metals[3].gds, 5, -5, 5.5, 8)],  # a crossing above
        [(M2, 5 + 2 * k, 2.2, 6.6 + 2 * k, 3.8) for k in range(6)],  # squares of fill
    ):
        assert nets(tmp_path, top(*ROUTE, *more))[0]["w"].femtofarad > bare


def test_corners_of_wires(tmp_path):
    typ, least, most = nets(tmp_path, top(*ROUTE), corners=CORNERS)
    assert least["w"].femtofarad < typ["w"].femtofarad < most["w"].femtofarad
    assert least["w"].resistors[0][2] < typ["w"].resistors[0][2] < most["w"].resistors[0][2]


def test_a_layout_that_is_not_the_netlist(tmp_path):
    with pytest.raises(StepError, match="does not connect w"):
        nets(tmp_path, top(*ROUTE[:4], *ROUTE[5:]))
    with pytest.raises(StepError, match=r"u1\.i has no metal"):
        nets(tmp_path, top(*ROUTE), [PLACES[0], [1, "inv", 40.0, 0.0, "0"]])


def test_the_spef_has_every_node_once(tmp_path):
    (found,) = nets(tmp_path, top(*ROUTE))
    text = spef(NETLIST, found)
    part = text[text.index("*D_NET w ") :]
    assert "*I u0:nq O\n*I u1:i I\n*CAP\n1 u0:nq " in part and "\n1 u0:nq u1:i " in part
    assert f"*D_NET w {found['w'].femtofarad:.4f}" in part
