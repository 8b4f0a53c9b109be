"""A shuttle's frame: what it refuses, the rows in it; Tiny Tapeout's ports where its template has them."""

from dataclasses import replace

import pytest

from talbot.models.parameters import ParameterError
from talbot.platforms.frame import Frame
from talbot.platforms.layout import layout_platform

FRAME = Frame(20.0, 15.0, (1.0, 2.0), (("a", 3.0), ("b", 5.0)), (0.3, 1.0), "met4", ("VPWR", "VGND"))


def test_the_rows_are_an_even_number_in_the_middle():
    columns, rows, origin = FRAME.core(0.5, 2.0)
    assert (columns, rows, origin) == (36, 4, (1.0, 3.5))


@pytest.mark.parametrize(
    "change, message",
    (
        ({"margin_um": (1.0, 8.0)}, "margin_um along y = 8.0"),
        ({"port_um": (0.3, 2.5)}, "port_um along y = 2.5"),
        ({"ports": (("a", 20.0),)}, "x_um of a = 20.0"),
        ({"ports": (("a", 3.0), ("a", 5.0))}, "a name twice"),
    ),
)
def test_it_refuses(change, message):
    with pytest.raises(ParameterError, match=message):
        replace(FRAME, **change)


def test_a_process_without_the_frame_says_so():
    with pytest.raises(ParameterError, match=r"pdk = 'ihp-sg13g2': must have the frame tt_1x1"):
        layout_platform("ihp-sg13g2").frame("tt_1x1")


@pytest.mark.parametrize("name, size", (("tt_1x1", (161.00, 111.52)), ("tt_1x2", (161.00, 225.76))))
def test_tiny_tapeouts_ports(name, size):
    """Places as in def/tt_block_1x1_pg.def and tt_block_1x2_pg.def of tt-support-tools."""
    tech = layout_platform("sky130")
    frame = tech.frame(name)
    ports = dict(frame.ports)
    assert (frame.width_um, frame.height_um) == size and len(ports) == 43
    assert [ports[net] for net in ("clk", "ena", "rst_n", "ui_in[0]", "ui_in[7]")] == [
        143.98, 146.74, 141.22, 138.46, 119.14,
    ]  # fmt: skip
    assert [ports[net] for net in ("uio_in[7]", "uo_out[7]", "uio_out[0]", "uio_oe[7]")] == [97.06, 74.98, 72.22, 30.82]
    _, _, (left, bottom) = frame.core(tech.site_um, tech.row_um)
    assert left >= 2.0 and 2.0 <= bottom <= 10.0
