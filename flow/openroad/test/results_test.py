"""Figures that are taken from the files of a run."""

import pytest

from talbot.flow.openroad.results import wire_um

DEF = """VERSION 5.8 ;
UNITS DISTANCE MICRONS 1000 ;
SPECIALNETS 1 ;
    - VPWR ( * VPWR ) + USE POWER + ROUTED met1 480 + SHAPE FOLLOWPIN ( 0 0 ) ( 90000 0 ) ;
END SPECIALNETS
NETS 2 ;
    - clk ( PIN clk ) ( a CLK ) + USE CLOCK + NONDEFAULTRULE CTS_NDR_0
      + ROUTED met3 ( 460 2000 0 ) ( 10460 * )
      NEW met2 ( 10460 2000 ) ( * 5000 )
      NEW met2 ( 10460 2000 ) M2M3_PR
      NEW met1 TAPER ( 10460 5000 ) RECT ( -70 0 70 300 )
      NEW li1 ( 10460 5000 ) L1M1_PR ;
    - n1 ( a Q ) ( b D ) + USE SIGNAL
      + ROUTED met1 ( 0 0 ) ( 1000 * ) ( * 500 0 ) M1M2_PR ;
END NETS
"""


def test_wire_is_that_of_the_signals_in_every_form_of_a_route():
    assert wire_um(DEF) == pytest.approx(10 + 3 + 1 + 0.5)


def test_a_layout_without_nets_has_no_wire():
    assert wire_um("UNITS DISTANCE MICRONS 1000 ;\nEND DESIGN\n") == 0
