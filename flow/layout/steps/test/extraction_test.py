"""Parasitics estimated from segments, and the names under which a timing tool finds them."""

import pytest

from talbot.flow.layout.timing.parasitics import parasitics
from talbot.platforms.layout import layout_platform
from talbot.signoff.netlist.netlist import Instance, Netlist, Port
from talbot.signoff.parasitics.spef import spef


def test_a_wire_counts_with_its_area_both_edges_and_its_squares():
    tech = layout_platform("sky130")
    m1, via = tech.metals[1], tech.vias[1]
    femtofarad, ohm = parasitics([["m1", 10.0, 0.2], ["m1_via_m2", 0, 0]], tech)
    assert femtofarad == pytest.approx(10 * (0.2 * m1.area_af_um2 + 2 * m1.fringe_af_um) / 1000)
    assert ohm == pytest.approx(10 / 0.2 * m1.sheet_ohm + via.ohm)


def test_a_bracket_is_a_bus_only_in_a_port():
    netlist = Netlist(
        "Top",
        (Port("a", "input", 2), Port("y", "output", 1)),
        (
            Instance("part.q[0]_reg", "dff_x1", {"i": "a[0]", "clk": "a[1]", "q": "part.q[0]"}),
            Instance("u1", "inv_x1", {"i": "part.q[0]", "nq": "y"}),
        ),
    )
    text = spef(netlist, {"a[0]": (1.0, 2.0), "part.q[0]": (3.0, 4.0)})
    assert "*D_NET a[0] 1.0000" in text
    assert r"*D_NET part\.q\[0\] 3.0000" in text
    assert r"*I part\.q\[0\]_reg:q O" in text and "*I u1:i I" in text
