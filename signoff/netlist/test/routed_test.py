"""A DEF as OpenROAD writes it: netlist, places, straps, lengths."""

import pytest

from talbot.base.steps import StepError
from talbot.signoff.netlist.netlist import Instance, Port
from talbot.signoff.netlist.routed import Routed

DEF = r"""VERSION 5.8 ;
DESIGN Top ;
UNITS DISTANCE MICRONS 1000 ;
DIEAREA ( 0 0 ) ( 10400 6240 ) ;
ROW ROW_0 compact 0 0 N DO 19 BY 1 STEP 520 0 ;
ROW ROW_1 compact 520 3120 FS DO 19 BY 1 STEP 520 0 ;
COMPONENTS 4 ;
    - ANTENNA_1 diode_w1 + SOURCE TIMING + PLACED ( 5200 0 ) N ;
    - FILLER_0 tie + SOURCE DIST + PLACED ( 6240 0 ) N ;
    - part.q\[0\]_reg dff_x1 + PLACED ( 0 3120 ) FS ;
    - u1 inv_x1 + PLACED ( 1040 0 ) FN ;
END COMPONENTS
PINS 2 ;
    - a[0] + NET a[0] + DIRECTION INPUT + USE SIGNAL
      + PORT
        + LAYER met3 ( -150 -150 ) ( 150 150 )
        + PLACED ( 0 150 ) N ;
    - y + NET y + DIRECTION OUTPUT + USE SIGNAL ;
END PINS
SPECIALNETS 2 ;
    - vdd ( PIN vdd ) ( * vdd ) + USE POWER
      + ROUTED met1 300 + SHAPE FOLLOWPIN ( 0 3120 ) ( 10400 3120 )
      NEW met4 1200 + SHAPE STRIPE ( 2600 0 ) ( 2600 6240 )
      NEW met3 0 + SHAPE STRIPE ( 2600 3120 ) via3_4_1200 ;
    - vss ( PIN vss ) ( * vss ) + USE GROUND
      + ROUTED met4 1200 + SHAPE STRIPE ( 7800 0 ) ( 7800 6240 ) ;
END SPECIALNETS
NETS 3 ;
    - a[0] ( PIN a[0] ) ( ANTENNA_1 i ) ( part.q\[0\]_reg i ) + USE SIGNAL
      + ROUTED met3 ( 0 150 ) ( 1000 * ) via2_0
      NEW met2 ( 1000 150 ) ( * 650 )
      NEW met2 ( 1000 650 ) RECT ( -70 -100 70 100 ) ;
    - part.q\[0\] ( u1 i ) ( part.q\[0\]_reg q ) + USE SIGNAL
      + ROUTED met1 ( 0 0 0 ) ( 200 * 70 ) ;
    - y ( PIN y ) ( u1 nq ) + USE SIGNAL ;
END NETS
END DESIGN
"""
WIDTHS = {"dff_x1": 5.2, "inv_x1": 1.56, "tie": 0.52}


@pytest.fixture
def routed(tmp_path):
    (tmp_path / "final.def").write_text(DEF)
    return Routed.read(tmp_path / "final.def", "met4", 3.12)


def test_the_netlist_has_the_names_of_the_verilog_and_no_diodes(routed):
    netlist = routed.netlist("Top", (Port("a", "input", 2), Port("y", "output", 1)))
    assert netlist.instances == (
        Instance("FILLER_0", "tie", {}),
        Instance("part.q[0]_reg", "dff_x1", {"i": "a[0]", "q": "part.q[0]"}),
        Instance("u1", "inv_x1", {"i": "part.q[0]", "nq": "y"}),
    )
    assert routed.diodes() == ["a[0]"]


def test_places_are_those_of_the_cells_origins(routed):
    rows = routed.instances(WIDTHS, 3.12)
    assert rows == [[None, "tie", 6.24, 0, "0"], [None, "dff_x1", 0, 6.24, "6"], [None, "inv_x1", 2.6, 0, "4"]]


def test_straps_and_lengths(routed):
    assert routed.size_um == (10.4, 6.24) and routed.core_um == (0, 0, 10.4, 6.24)
    assert routed.straps == (("vdd", 2.6), ("vss", 7.8))
    assert (routed.wire_um, routed.vias) == (1.7, 1)


def test_a_file_that_is_no_def(tmp_path):
    (tmp_path / "x.def").write_text("")
    with pytest.raises(StepError, match="must be a DEF file with UNITS and DIEAREA"):
        Routed.read(tmp_path / "x.def", "met4", 3.12)
