"""A shift register with delays in Icarus: right when it has time, and each thing that is wrong is found."""

import json
from dataclasses import replace

import pytest

from talbot.flow.layout.timing import delays
from talbot.flow.layout.timing.replay import SETTLED, Timing, replay
from talbot.signoff.netlist.netlist import Instance
from talbot.signoff.netlist.test import shift_register as small

pytestmark = pytest.mark.needs("iverilog")
SDF = """(DELAYFILE (SDFVERSION "3.0")
 (CELL (CELLTYPE "Shift") (INSTANCE) (DELAY (ABSOLUTE
  (INTERCONNECT first\\.d_reg/q u0/i (0.01::0.25) (0.01::0.25)) (INTERCONNECT a u_n/i (0::0) (0::0)))))
 (CELL (CELLTYPE "inv_x1") (INSTANCE u0) (DELAY (ABSOLUTE (IOPATH i nq (0.1::0.2) (0.1::0.4)))))
 (CELL (CELLTYPE "inv_x1") (INSTANCE u_n) (DELAY (ABSOLUTE (IOPATH i nq (0.1::0.1) (0.1::0.1)))))
 (CELL (CELLTYPE "dff_x1") (INSTANCE first\\.d_reg) (DELAY (ABSOLUTE (IOPATH clk q (0.5::0.5) (0.5::0.5))))
  (TIMINGCHECK (HOLD (posedge i) (posedge clk) (0.05::0.1)) (HOLD (negedge i) (posedge clk) (0.0::0.0))
   (SETUP (posedge i) (posedge clk) (0.2::0.2)) (SETUP (negedge i) (posedge clk) (0.1::0.1))))
 (CELL (CELLTYPE "dff_x1") (INSTANCE second\\.d_reg) (DELAY (ABSOLUTE (IOPATH clk q (0.5::0.5) (0.5::0.5))))
  (TIMINGCHECK (HOLD (posedge i) (posedge clk) (0.1::0.1)) (SETUP (posedge i) (posedge clk) (0.2::0.2))))
)"""
EASY = Timing(10.0, 0.2, 0.2)


def played(folder, netlist, timing=EASY, sdf=SDF, inverted=1, count=False, cells=small.CELLS):
    (folder / "t.trace").write_text("\n".join(small.trace(200, inverted)) + "\n")
    (folder / "t.json").write_text(json.dumps(small.HEAD | {"cycles": 200}))
    return replay(netlist, cells, folder / "t.json", timing, folder, delays.read(sdf) if sdf else None, count)


def test_what_is_read_of_an_sdf():
    found = delays.read(SDF)
    assert found.paths["u0"] == [("i", "nq", 0.2, 0.4)]
    assert found.nets["first.d_reg", "q"] == (0.25, 0.25)
    assert found.checks["first.d_reg"] == {"i": [0.2, 0.1]}  # the later of both edges


def test_margins_are_those_of_the_path(tmp_path):
    found = played(tmp_path, small.shift())
    assert (found.wrong, found.late) == (0, ())
    # clock to q 0.5, wire 0.25, inverter 0.2 or 0.4: the next edge is 10 ns on; first.d's input comes at 2 ns
    assert found.margins[0] == pytest.approx(10 - 2 - 0.2)
    assert found.margins[1] == pytest.approx(0.5 + 0.25 + 0.2 - 0.1)


def test_a_clock_too_fast_for_the_setup_is_found(tmp_path):
    found = played(tmp_path, small.shift(), Timing(1.3, 0.1, 0.1))
    assert any(line.startswith("SETUP") for line in found.late) and found.margins[0] < 0


def test_a_race_is_found(tmp_path):
    fast = SDF.replace("0.5::0.5", "0.02::0.02").replace("0.01::0.25", "0::0").replace("0.1::0.2", "0::0.01")
    found = played(tmp_path, small.shift(), sdf=fast.replace("0.1::0.4", "0::0.01"))
    assert any(line.startswith("HOLD") for line in found.late) and found.margins[1] < 0


@pytest.mark.parametrize("sdf", [SDF.replace("i nq (0.1::0.2)", "i q (0.1::0.2)"), None])
def test_a_swapped_cell_is_found(tmp_path, sdf):
    netlist = small.shift()
    instances = tuple(
        Instance(i.name, "buf_x1", {"i": i.pins["i"], "q": i.pins["nq"]}) if i.name == "u0" else i
        for i in netlist.instances
    )
    found = played(tmp_path, replace(netlist, instances=instances), sdf=sdf)
    assert found.wrong > 50 and found.first


def test_a_net_that_nothing_drives_is_x(tmp_path):
    netlist = small.shift()
    cut = tuple(
        replace(i, pins=i.pins | {"i": "nowhere"}) if i.name == "second.d_reg" else i for i in netlist.instances
    )
    assert played(tmp_path, replace(netlist, instances=cut)).wrong == 198


def test_a_cell_with_two_inputs_on_one_net_has_its_delays(tmp_path):
    cells = (
        small.CELLS
        + "module nand_x1 (i0, i1, nq);\n  input i0, i1;\n  output nq;\n  assign nq = ~(i0 & i1);\nendmodule\n"
    )
    netlist = small.shift()
    instances = tuple(
        Instance("u0", "nand_x1", {"i0": i.pins["i"], "i1": i.pins["i"], "nq": i.pins["nq"]}) if i.name == "u0" else i
        for i in netlist.instances
    )
    paths = " ".join(
        f"(IOPATH {pin} nq ({delay}) ({delay}))" for pin, delay in (("i0", "0.1::0.4"), ("i1", "0.1::0.2"))
    )
    sdf = SDF.replace("(IOPATH i nq (0.1::0.2) (0.1::0.4))", paths)
    found = played(tmp_path, replace(netlist, instances=instances), sdf=sdf, cells=cells)
    assert (found.wrong, found.late) == (0, ())
    assert found.margins[1] == pytest.approx(0.5 + 0.25 + 0.2 - 0.1)  # by the faster one, which is the second


def test_transitions_are_counted(tmp_path):
    found = played(tmp_path, small.shift(), count=True)
    bits = [int(line.split()[1], 16) for line in small.trace(200, 1)]
    changes = sum(a != b for a, b in zip(bits[SETTLED:], bits[SETTLED + 1 :]))
    assert found.activity["a"][0] == pytest.approx(changes / (200 - SETTLED), abs=0.02)
    assert found.activity["clk"] == pytest.approx((2, 0.5), abs=0.02)
    assert found.activity["n"][1] == pytest.approx(1 - found.activity["a"][1], abs=0.02)
