"""Netlists of our own: what they do is found, what is wrong in them is said."""

import pytest

from talbot.cells.netlist.boolean import expression
from talbot.cells.netlist.check import check
from talbot.cells.netlist.function import understand
from talbot.cells.netlist.spice import number, parse
from talbot.models.parameters import ParameterError

POLARITY, RAILS = {"n": "n", "p": "p"}, {"VDD": 1, "VSS": 0}


def cell(lines, ports):
    """A subcircuit of 'name drain gate source' lines; n transistors lie in VSS, p in VDD."""
    body = []
    for line in lines:
        name, drain, gate, source = line.split()
        kind = name[0]
        bulk, width = ("VSS", 1) if kind == "n" else ("VDD", 2)
        body.append(f"X{name} {drain} {gate} {source} {bulk} {kind} w={width} l=0.15")
    return parse("\n".join([f".subckt cell {ports} VDD VSS", *body, ".ends"]))


def inverter(name, a, y):
    return [f"n{name} {y} {a} VSS", f"p{name} {y} {a} VDD"]


def gate(name, a, b, on, off):
    """A transmission gate that conducts while ``on`` is 1."""
    return [f"n{name} {a} {on} {b}", f"p{name} {a} {off} {b}"]


NAND = ["n1 Y A m", "n2 m B VSS", "p1 Y A VDD", "p2 Y B VDD"]
LATCH = [
    *inverter("g", "G", "gn"),
    *inverter("d", "D", "dn"),
    *gate("i", "dn", "s", "G", "gn"),
    *inverter("q", "s", "Q"),
    *inverter("f", "Q", "fb"),
    *gate("f", "fb", "s", "gn", "G"),
]
FLIP_FLOP = [
    *inverter("c", "C", "cn"),
    *inverter("cc", "cn", "cp"),
    *inverter("d", "D", "dn"),
    *gate("m", "dn", "m", "cn", "cp"),
    *inverter("m", "m", "mq"),
    *inverter("mf", "mq", "mf"),
    *gate("mf", "mf", "m", "cp", "cn"),
    *gate("s", "mq", "s", "cp", "cn"),
    *inverter("s", "s", "sq"),
    *inverter("sf", "sq", "sf"),
    *gate("sf", "sf", "s", "cn", "cp"),
    *inverter("q", "s", "Q"),
]


def test_a_nand_is_found():
    found = understand(cell(NAND, "A B Y"), POLARITY, RAILS)
    assert (found.machine.inputs, found.machine.outputs) == (("A", "B"), ("Y",))
    assert found.functions == {"Y": "!A | !B"} and found.storage is None
    assert {(a.pin, a.pin_edge, a.edge, a.sense) for a in found.arcs} == {
        (pin, up, down, "negative_unate") for pin in "AB" for up, down in (("rise", "fall"), ("fall", "rise"))
    }


def test_a_latch_is_found():
    found = understand(cell(LATCH, "D G Q"), POLARITY, RAILS)
    assert (found.storage.kind, found.storage.clock, found.storage.active, found.storage.data) == ("latch", "G", 1, "D")
    assert {a.type for a in found.arcs} == {"combinational", "rising_edge"}


def test_a_flip_flop_is_found():
    found = understand(cell(FLIP_FLOP, "C D Q"), POLARITY, RAILS)
    assert (found.storage.kind, found.storage.clock, found.storage.active, found.storage.data) == ("ff", "C", 1, "!D")
    assert {(a.pin, a.pin_edge, a.type) for a in found.arcs} == {("C", "rise", "rising_edge")}


def test_a_tri_state_buffer_is_found():
    lines = [*inverter("e", "E", "en"), "n1 Z A m", "n2 m E VSS", "p1 Z A k", "p2 k en VDD"]
    found = understand(cell(lines, "A E Z"), POLARITY, RAILS)
    assert found.functions == {"Z": "!A"} and found.three_state == {"Z": "!E"}
    off = {(a.pin_edge, a.edge, a.sense) for a in found.arcs if a.type == "three_state_disable"}
    on = {(a.pin_edge, a.edge, a.sense) for a in found.arcs if a.type == "three_state_enable"}
    assert off == {("fall", "rise", "negative_unate"), ("fall", "fall", "negative_unate")}  # from low, from high
    assert on == {("rise", "rise", "positive_unate"), ("rise", "fall", "positive_unate")}
    assert {a.type for a in found.arcs} == {"combinational", "three_state_enable", "three_state_disable"}


@pytest.mark.parametrize(
    "lines, ports, why",
    [
        ([*NAND, "n3 Y float VSS"], "A B Y", "gate of Xn3 is floating: nothing drives node float"),
        (NAND, "A B C Y", "port C is connected to nothing"),
        ([], "A Y", "has no transistor"),
    ],
)
def test_a_wrong_netlist_is_refused_by_name(lines, ports, why):
    with pytest.raises(ParameterError, match=why):
        check(cell(lines, ports), POLARITY, RAILS)


def test_a_missing_model_a_missing_rail_and_a_wrong_port_are_named():
    netlist = cell(NAND, "A B Y")
    with pytest.raises(ParameterError, match="has model p, which the process does not have"):
        check(netlist, {"n": "n"}, RAILS)
    with pytest.raises(ParameterError, match="port VPB or VPWR is missing; it has A, B, Y, VDD, VSS"):
        check(netlist, POLARITY, {"VPB": 1, "VPWR": 1, "VSS": 0})
    with pytest.raises(ParameterError, match="ports: duplicate name A"):
        check(cell(NAND, "A B Y A"), POLARITY, RAILS)


ODD = """* words in any case, lines that go on, comments of three kinds, quotes, spaces around =
.include "models.spice"
.GLOBAL vdd
.SUBCKT Inv a Y Vdd VSS PARAMS: x=1
* a comment in between
MN0 y A VSS vss / N W = 0.65u L='0.15'
+ M=2 $ two of them
XP0 Y A VDD Vdd p w={1.0} l=1.5E-1 ; one
C0 Y VSS C=0.5f
R$1 A a$b 1.5k
.Ends Inv
"""


def test_spice_as_people_write_it():
    netlist = parse(ODD)
    assert (netlist.name, netlist.ports) == ("Inv", ("a", "Y", "Vdd", "VSS"))
    assert [(t.name, t.model, t.drain, t.gate, t.source, t.bulk) for t in netlist.transistors] == [
        ("MN0", "n", "Y", "a", "VSS", "VSS"),
        ("MN0_m1", "n", "Y", "a", "VSS", "VSS"),
        ("XP0", "p", "Y", "a", "Vdd", "Vdd"),
    ]
    assert [(t.size["w"], t.size["l"]) for t in netlist.transistors] == [
        (pytest.approx(0.65e-6), 0.15),
        (pytest.approx(0.65e-6), 0.15),
        (1.0, 0.15),
    ]
    assert (netlist.capacitors[0].value, netlist.resistors[0].value) == (pytest.approx(0.5e-15), 1500.0)
    assert (netlist.resistors[0].name, netlist.resistors[0].b) == ("R$1", "a$b")


@pytest.mark.parametrize(
    "old, new, why",
    [
        ("M=2", "M=1.5", "must have a whole number m of 1 or more"),
        ("M=2", "M=two", "netlist = 'two': must be a number"),
        (".Ends Inv", "", ".subckt Inv has no .ends"),
        (".SUBCKT Inv a Y Vdd VSS PARAMS: x=1", ".SUBCKT", "must have a unique name and be outside other subcircuits"),
        (".Ends Inv", ".subckt Inv a Y\n.ends\n", "must have a unique name and be outside other subcircuits"),
        ("XP0 Y A VDD Vdd p", "XP0 Y A VDD p", "must be a transistor: drain gate source bulk model"),
    ],
)
def test_lines_that_are_not_understood_are_named(old, new, why):
    with pytest.raises(ParameterError, match=why):
        parse(ODD.replace(old, new))


def test_a_negative_resistor_is_refused():
    with pytest.raises(ParameterError, match=r"netlist = cell: R0 must be 0 or more"):
        netlist = parse(
            "\n".join(
                [
                    ".subckt cell A Y VDD VSS",
                    "X0 Y A VSS VSS n w=1 l=1",
                    "X1 Y A VDD VDD p w=1 l=1",
                    "R0 A Y -5",
                    ".ends",
                ]
            )
        )
        check(netlist, POLARITY, RAILS)


@pytest.mark.parametrize(
    "text, value", [("650000u", 0.65), ("1e+06u", 1.0), ("0.42", 0.42), ("10meg", 1e7), ("0.0518f", 0.0518e-15)]
)
def test_numbers(text, value):
    assert number(text) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("names", ["AB", "ABC", "ABCD"])
def test_expressions_have_the_truth_table(names):
    """Every function of two, and every 37th of three and four variables."""
    size = 1 << len(names)
    for table in range(0, 1 << size, 1 if size == 4 else 37 if size == 8 else 4099):
        ones = {m for m in range(size) if table >> m & 1}
        text = expression(names, ones).replace("!", " not ").replace("&", "and").replace("|", "or")
        for m in range(size):
            levels = {name: bool(m >> (len(names) - 1 - i) & 1) for i, name in enumerate(names)}
            assert bool(eval(text, levels)) == (m in ones)
