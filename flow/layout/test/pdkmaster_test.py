"""Exports of the cells for other tools."""

from flow.layout.pdkmaster import with_short_pads, with_transistors
from platforms.coriolis import coriolis_platform

SPICE = """.subckt inv_x1 vdd vss i nq
Xnmos vss i nq vss sg13_lv_nmos l=1.3e-07 w=7.8e-07
.ends
.subckt two vdd vss a b c d
X1 vdd vss a b inv_x1
Mp vdd a b vdd pfet l=1 w=2
X2 vdd vss a b inv_x1 m=2
.ends
"""


def test_a_transistor_is_one_and_a_cell_stays_a_cell():
    lines = with_transistors(SPICE).splitlines()
    assert lines[1] == "Mnmos vss i nq vss sg13_lv_nmos l=1.3e-07 w=7.8e-07"
    assert lines[4:7] == ["X1 vdd vss a b inv_x1", "Mp vdd a b vdd pfet l=1 w=2", "X2 vdd vss a b inv_x1 m=2"]


def test_pads_below_the_top_layer_are_as_long_as_their_area_requires():
    tech = coriolis_platform("sky130")
    text = (
        "via = tech.getLayer('m2_via2_m3')\n    setEnclosures(via, metal, (u(0.085), u(0.09)))\n"
        "via = tech.getLayer('m3_via3_m4')\n    setEnclosures(via, metal, (u(0.49), u(0.09)))\n"
    )
    made, found = with_short_pads(text, "m3", "m4", tech.vias[-1], 0.24)
    assert found == 1 and made == text.replace("u(0.49)", "u(0.22)")  # (0.2 + 2 x 0.22) x 0.38 um2 = 0.243
    assert with_short_pads(text, "m3", "m4", tech.vias[-1], 0.9)[0] == text  # never longer than they were
    assert with_short_pads(text, "m3", "m4", tech.vias[-1], 0.0)[0] == text.replace("u(0.49)", "u(0.09)")
    assert with_short_pads("", "m3", "m4", tech.vias[-1], 0.24) == ("", 0)
