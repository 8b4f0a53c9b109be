"""Buffer trees: no net exceeds the fan-out, no pin is lost, near cells share a buffer."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.signoff.netlist.buffering import buffer_fan_out, buffer_outputs, clusters, estimated
from talbot.signoff.netlist.netlist import Buffer, Instance, Netlist, Port

BUFFER = Buffer("buf_x1", "i", "q")


def chain(length, wide):
    """A row of inverters from port a to port z; `enable` goes to ``wide`` of them, evenly spaced."""
    nets = ["a", *(f"n{k}" for k in range(length - 1)), "z"]
    taps = set(np.linspace(0, length - 1, wide).astype(int))
    cells = [
        Instance(
            f"u{k}",
            "nand2_x0" if k in taps else "inv_x0",
            {"i0" if k in taps else "i": nets[k], "nq": nets[k + 1]} | ({"i1": "enable"} if k in taps else {}),
        )
        for k in range(length)
    ]
    return Netlist("Chain", (Port("a", "input", 1), Port("enable", "input", 1), Port("z", "output", 1)), tuple(cells))


def sinks(netlist):
    return Counter(net for i in netlist.instances for pin, net in i.pins.items() if pin not in ("q", "nq"))


def source(netlist, net):
    """The net that ``net`` is a copy of."""
    sources = {i.pins["q"]: i.pins["i"] for i in netlist.instances if i.cell == "buf_x1"}
    while net in sources:
        net = sources[net]
    return net


@pytest.mark.parametrize("wide", (3, 4, 5, 17, 64, 65, 150))
def test_no_net_has_more_and_every_pin_has_its_signal(wide):
    plain = chain(200, wide)
    made = buffer_fan_out(plain, {"west": ["a", "enable"], "east": ["z"]}, BUFFER, 4)
    assert max(sinks(made).values()) <= 4
    for before, after in zip(plain.instances, made.instances, strict=False):
        assert {pin: source(made, net) for pin, net in after.pins.items()} == before.pins
    names = [i.name for i in made.instances]
    assert len(set(names)) == len(names) and not set(names) & set(sinks(made))
    assert (len(made.instances) > len(plain.instances)) == (wide > 4)


def test_a_clock_is_left_alone():
    cells = tuple(Instance(f"r{k}", "dff_x1", {"clk": "clk", "i": "d", "q": f"q{k}"}) for k in range(20))
    made = buffer_fan_out(
        Netlist("Flat", (Port("clk", "input", 1), Port("d", "input", 1)), cells),
        {"west": ["clk"], "east": ["d"]},
        BUFFER,
        5,
    )
    assert sinks(made)["clk"] == 20
    assert sinks(made)["d"] == 4


def test_positions_follow_the_nets_from_port_to_port():
    plain = chain(50, 10)
    x = estimated(plain.instances, {"west": ["a"], "east": ["z"]}, {"enable"})[:, 0]
    assert np.all(np.diff(x) > 0)


def test_a_buffer_s_cells_are_neighbours():
    plain = chain(120, 40)
    made = buffer_fan_out(plain, {"west": ["a", "enable"], "east": ["z"]}, BUFFER, 8)
    for i in made.instances:
        if i.cell == "buf_x1":
            number = [k for k, other in enumerate(made.instances[:120]) if i.pins["q"] in other.pins.values()]
            assert not number or max(number) - min(number) < 120 / 40 * 8


@given(st.integers(1, 60), st.integers(2, 9), st.integers(0, 2**32 - 1))
def test_groups_hold_every_place_once(count, most, seed):
    places = np.random.default_rng(seed).integers(0, 5, (count, 2)) / 5
    groups = clusters(places, most)
    assert sorted(np.concatenate(groups)) == list(range(count))
    assert len(groups) == -(-count // most)
    assert max(map(len, groups)) <= most and min(map(len, groups)) >= 1


def test_an_output_has_a_buffer_of_its_own():
    """Whatever reads the net within reads it in front of the buffer, which alone leads out."""
    read = Instance("reader", "inv_x0", {"i": "z", "nq": "n"})
    made = buffer_outputs(
        Netlist(
            "Two",
            (Port("a", "input", 1), Port("z", "output", 1)),
            (Instance("source", "inv_x0", {"i": "a", "nq": "z"}), read),
        ),
        BUFFER,
    )
    assert [(i.cell, i.pins) for i in made.instances] == [
        ("inv_x0", {"i": "a", "nq": "z_within"}),
        ("inv_x0", {"i": "z_within", "nq": "n"}),
        ("buf_x1", {"i": "z_within", "q": "z"}),
    ]


def test_a_weak_driver_alone_gets_a_buffer():
    cells = {"a": "nor3_x1", "b": "inv_x4"}
    made = buffer_outputs(
        Netlist(
            "Two",
            (Port("i", "input", 1), *(Port(name, "output", 1) for name in cells)),
            tuple(Instance(f"of_{name}", cell, {"i": "i", "nq": name}) for name, cell in cells.items()),
        ),
        BUFFER,
        {"nor3_x1"},
    )
    assert [(i.cell, *i.pins.values()) for i in made.instances] == [
        ("nor3_x1", "i", "a_within"),
        ("inv_x4", "i", "b"),
        ("buf_x1", "a_within", "a"),
    ]
