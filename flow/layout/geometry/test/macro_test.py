"""Blocks laid out before: what is read of their LEF, where they may stand, and the design put together with them."""

import pytest

from flow.layout.geometry.assembly import flat, together
from flow.layout.geometry.macro import Macro
from flow.layout.netlist.netlist import Buffer, Instance, Netlist, Port
from flow.layout.netlist.test import shift_register as small
from flow.layout.steps.floorplan import FloorplanParameters, free, placed
from flow.layout.steps.ir_drop import breaks
from flow.layout.steps.place_route import plain_blocks, routed_netlist
from models.parameters import ParameterError
from platforms.coriolis import coriolis_platform

LEF = """VERSION 5.8 ;
MACRO Block
  CLASS BLOCK ;
  SIZE 40.000 BY 56.000 ;
  PIN a
    DIRECTION INPUT ;
    USE SIGNAL ;
    PORT
      LAYER met1 ;
        RECT 0.000 10.000 0.185 10.320 ;
      LAYER met1 ;
        RECT 0.000 13.000 0.300 13.320 ;
      LAYER met2 ;
        RECT 0.000 10.000 0.185 13.320 ;
    END
  END a
  PIN b[0]
    DIRECTION OUTPUT ;
    USE SIGNAL ;
    PORT
      LAYER met1 ;
        RECT 0.000 13.460 0.300 13.780 ;
    END
  END b[0]
  PIN vdd
    DIRECTION INOUT ;
    USE POWER ;
    PORT
      LAYER met4 ;
        RECT 28.400 0.000 29.600 56.000 ;
    END
  END vdd
  PIN vss
    DIRECTION INOUT ;
    USE GROUND ;
    PORT
      LAYER met4 ;
        RECT 9.400 0.000 10.600 56.000 ;
    END
  END vss
END Block
"""


@pytest.fixture
def known():
    return coriolis_platform("sky130")


@pytest.fixture
def block(known, tmp_path):
    (tmp_path / "block.lef").write_text(LEF)
    return Macro.read(tmp_path / "block.lef", known)


def test_a_pin_is_met_where_it_is_farthest_from_others(block):
    assert (block.name, block.width_um, block.height_um) == ("Block", 40.0, 56.0)
    assert block.pins == {
        "a": ("input", "m1", (0.0, 10.0, 0.185, 10.32)),
        "b[0]": ("output", "m1", (0.0, 13.46, 0.3, 13.78)),
    }
    assert block.straps == (("vss", 10.0), ("vdd", 29.0))


def test_blocks_stand_on_rows_of_their_own_parity(block, known):
    places = placed([("left", block, (0.1, 0.0)), ("right", block, (0.9, 0.6))], 240.0, 168.0, known)
    for place in places:
        assert place["y_um"] / (2 * known.row_um) == pytest.approx(round(place["y_um"] / (2 * known.row_um)))
        left, bottom, right, top = place["outer"]
        assert left / known.row_um == pytest.approx(round(left / known.row_um))
        assert left + 16.8 == pytest.approx(place["x_um"]) and right >= place["x_um"] + 40.0 + 16.8
        assert top == pytest.approx(place["y_um"] + 56.0 + 11.2)
        assert bottom == pytest.approx(max(0, place["y_um"] - 11.2))
    assert breaks(places[:1]) == [
        (places[0]["outer"][0], 0.0, places[0]["x_um"], 56.0),
        (places[0]["x_um"] + 40.0, 0.0, places[0]["outer"][2], 56.0),
    ]


@pytest.mark.parametrize(
    "macros, width, words",
    [
        ([("one", (0.5, 0.0)), ("two", (0.5, 1.0))], 240.0, "one: must be 15 um west of two"),  # one above the other
        ([("one", (0.0, 0.0))], 240.0, "the west edge: must be 15 um west of one"),
        ([("one", (0.5, 0.0))], 60.0, "does not fit"),
    ],
)
def test_blocks_that_cannot_stand(block, known, macros, width, words):
    with pytest.raises(ParameterError, match=words):
        placed([(name, block, at) for name, at in macros], width, 168.0, known)
    with pytest.raises(ParameterError, match="macros of one"):
        FloorplanParameters(macros=(("one", "Block", 1.2, 0.0),))


def test_the_tree_is_built_beside_the_blocks():
    plan = {"width_um": 200.0, "height_um": 160.0, "macros": [{"outer": [40.0, 0.0, 160.0, 60.0]}]}
    assert free(plan) == [10.0, 60.0, 190.0, 160.0]  # the rest on its north, cut to 1.8 times its height
    assert free(plan | {"macros": []}) == [0.0, 0.0, 200.0, 160.0]


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


def test_flat_is_the_block_in_place_of_its_instance():
    made = {i.name: i for i in flat(top(), {"part.shift": small.shift()}).instances}
    assert set(made) == {"u0", "u1", *(f"part.shift.{i.name}" for i in small.shift().instances)}
    assert made["part.shift.first.d_reg"].pins == {"i": "n0", "clk": "clk", "q": "part.shift.w0"}
    assert made["part.shift.second.d_reg"].pins == {"i": "part.shift.w1", "clk": "clk", "q": "n1"}


def test_wires_that_reach_into_a_block_are_one():
    def wire(layer, length):
        return [[layer, length, 0.3]]

    outside = {
        "straps": [],
        "pins": [],
        "segments": {"n0": wire("m1", 5.0), "n2": []},
        "instances": [[0, "inv_x1", 1.0, 0.0, "0"], [1, "macro0", 40.0, 0.0, "0"], [2, "inv_x1", 9.0, 0.0, "0"]],
    }
    inside = {
        "segments": {"a": wire("m2", 7.0), "w0": wire("m3", 2.0)},
        "instances": [[k, i.cell, 1.6 * k, 5.6, "0"] for k, i in enumerate(small.shift().instances)],
    }
    whole = together(top(), outside, {"part.shift": (small.shift(), inside)}, {"part.shift": (50.0, 11.2)})
    assert whole["segments"] == {"n0": wire("m1", 5.0) + wire("m2", 7.0), "n2": [], "part.shift.w0": wire("m3", 2.0)}
    names = [i.name for i in flat(top(), {"part.shift": small.shift()}).instances]
    assert len(whole["instances"]) == len(names)
    assert whole["instances"][names.index("part.shift.first.d_reg")][1:4] == ["dff_x1", 50.0, 16.8]


def test_inputs_reach_blocks_through_buffers_but_clocks_do_not():
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


def test_a_block_has_plain_names_in_the_router_and_its_own_behind_it():
    bus = Netlist(
        "Top",
        (Port("a", "input", 2),),
        (Instance("b", "Block", {"d[1]": "a[1]", "d[0]": "a[0]", "q": "n0"}), Instance("u0", "inv_x1", {"i": "n0"})),
    )
    blocks = plain_blocks(bus, [{"instance": "b"}])
    assert blocks == {"b": ("macro0", {"d[1]": "p0", "d[0]": "p1", "q": "p2"})}
    names = {"a[1]": "w1", "a[0]": "w0", "n0": "w2"}
    assert ".gate macro0 p0=w1 p1=w0 p2=w2\n" in bus.blif("m", names, blocks)
    routed = routed_netlist(
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
