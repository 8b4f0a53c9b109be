"""Macros in a netlist: flattened, behind buffers, and by plain names in the router."""

from talbot.flow.layout.netlist.flatten import flattened, merged_placement
from talbot.flow.layout.netlist.names import plain_macros
from talbot.flow.layout.netlist.netlist import Buffer, Instance, Netlist, Port
from talbot.flow.layout.netlist.placed import placed_netlist
from talbot.flow.layout.netlist.test.shift_register import shift


def top():
    """Shift between two cells of its own, its second output unused."""
    return Netlist(
        "Top",
        (Port("clk", "input", 1), Port("in", "input", 1), Port("out", "output", 1)),
        (
            Instance("u0", "inv_x1", {"i": "in", "nq": "n0"}),
            Instance("part.shift", "Shift", {"clk": "clk", "a": "n0", "y": "n1", "n": "n2"}),
            Instance("u1", "inv_x1", {"i": "n1", "nq": "out"}),
        ),
    )


def test_a_macro_is_flattened_in_place_of_its_instance():
    made = {i.name: i for i in flattened(top(), {"part.shift": shift()}).instances}
    assert set(made) == {"u0", "u1", *(f"part.shift.{i.name}" for i in shift().instances)}
    assert made["part.shift.first.d_reg"].pins == {"i": "n0", "clk": "clk", "q": "part.shift.w0"}
    assert made["part.shift.second.d_reg"].pins == {"i": "part.shift.w1", "clk": "clk", "q": "n1"}


def test_segments_of_a_net_that_reaches_into_a_macro_are_one_list():
    def segments(layer, length):
        return [[layer, length, 0.3]]

    outside = {
        "straps": [],
        "pins": [],
        "segments": {"n0": segments("m1", 5.0), "n2": []},
        "instances": [[0, "inv_x1", 1.0, 0.0, "0"], [1, "macro0", 40.0, 0.0, "0"], [2, "inv_x1", 9.0, 0.0, "0"]],
    }
    inside = {
        "segments": {"a": segments("m2", 7.0), "w0": segments("m3", 2.0)},
        "instances": [[k, i.cell, 1.6 * k, 5.6, "0"] for k, i in enumerate(shift().instances)],
    }
    whole = merged_placement(top(), outside, {"part.shift": inside}, {"part.shift": (50.0, 11.2)})
    assert whole["segments"] == {
        "n0": segments("m1", 5.0) + segments("m2", 7.0),
        "n2": [],
        "part.shift.w0": segments("m3", 2.0),
    }
    names = [i.name for i in flattened(top(), {"part.shift": shift()}).instances]
    assert len(whole["instances"]) == len(names)
    assert whole["instances"][names.index("part.shift.first.d_reg")][1:4] == ["dff_x1", 50.0, 16.8]


def test_inputs_reach_macros_through_buffers_but_clocks_do_not():
    bare = Netlist(
        "Top",
        (Port("clk", "input", 1), Port("in", "input", 1), Port("out", "output", 1)),
        (
            Instance("block", "Shift", {"clk": "clk", "a": "in", "y": "n1", "n": "n2"}),
            Instance("d_reg", "dff_x1", {"i": "n1", "clk": "clk", "q": "out"}),
        ),
    )
    made = bare.with_input_buffers(("Shift",), Buffer("buf_x1", "i", "q"))
    assert made.instances[0].pins == {"clk": "clk", "a": "in_inside", "y": "n1", "n": "n2"}
    assert made.instances[2:] == (Instance("inside0", "buf_x1", {"i": "in", "q": "in_inside"}),)
    assert bare.with_input_buffers((), Buffer("buf_x1", "i", "q")) == bare


def test_a_macro_has_plain_names_in_the_router_and_its_own_after_it():
    bus = Netlist(
        "Top",
        (Port("a", "input", 2),),
        (Instance("b", "Block", {"d[1]": "a[1]", "d[0]": "a[0]", "q": "n0"}), Instance("u0", "inv_x1", {"i": "n0"})),
    )
    blocks = plain_macros(bus, [{"instance": "b"}])
    assert blocks == {"b": ("macro0", {"d[1]": "p0", "d[0]": "p1", "q": "p2"})}
    names = {"a[1]": "w1", "a[0]": "w0", "n0": "w2"}
    assert ".gate macro0 p0=w1 p1=w0 p2=w2\n" in bus.blif("m", names, blocks)
    routed = placed_netlist(
        bus,
        names,
        [
            ["subckt_0_macro0", "macro0", 0, 0, "0", {"p0": "w1", "p1": "w0", "p2": "w2"}],
            ["subckt_1_inv_x1", "inv_x1", 0, 0, "0", {"i": "w2", "vdd": "vdd"}],
        ],
        blocks,
    )
    assert routed == bus
    assert "  Block b (.d({a[1], a[0]}), .q(n0));\n" in bus.verilog()
