"""Exports of the cells for other tools."""

from talbot.signoff.pdkmaster import with_transistors

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
