"""What the reference of the comparison with the layout lists: connected ports, diodes, fill as it is drawn."""

from talbot.signoff.netlist.netlist import Instance, Netlist, Port, with_diodes

PORTS = Port("a", "input", 2), Port("b", "input", 1), Port("q", "output", 1)
NETLIST = Netlist(
    "Top",
    PORTS,
    (Instance("u0", "inv_x1", {"i": "a[1]", "nq": "q"}), *(Instance(f"f{k}", "tie_w8", {}) for k in range(3))),
)
CELLS = ".subckt inv_x1 i nq vdd vss\n.ends\n.subckt tie_w8 vss vdd\n.ends\n"


def test_ports_without_a_cell_are_left_out_and_supplies_have_the_layouts_names():
    lines = NETLIST.spice(CELLS, ("VPWR", "VGND")).splitlines()
    assert NETLIST.connected_ports() == ["a[1]", "q"]
    assert lines[:3] == [".subckt Top a[1] q VPWR VGND", "X0 a[1] q VPWR VGND inv_x1", "X1 VGND VPWR tie_w8"]


def test_diodes_take_the_place_of_fill():
    made = with_diodes(NETLIST, ["a[1]"], {"tie_w8": -2, "tie_w4": 1})
    assert [(i.cell, i.pins) for i in made.instances[1:]] == [
        ("tie_w8", {}),
        ("tie_w4", {}),
        ("diode_w1", {"i": "a[1]"}),
    ]
    assert with_diodes(NETLIST, [], {}) == NETLIST
    assert "  diode_w1 antenna_0 (.i(a[1]));" in made.verilog().splitlines()
