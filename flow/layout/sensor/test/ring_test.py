"""Pads and fillers around any lines: a line of the top metal meets its own track alone, and what cannot be is named."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.flow.layout.sensor.plan import NoRoom
from talbot.flow.layout.sensor.ring import (
    ANALOG,
    BESIDE_CHIP,
    CIRCUITS_ON_SIDE,
    GAP,
    TOP,
    UM,
    Frame,
    Pads,
    Way,
    bridges,
    ring,
    signal,
)
from talbot.flow.layout.sensor.test import small
from talbot.platforms.pads import pad_process

pytestmark = pytest.mark.needs("layout")

PROCESS, WIDTH, LINE = pad_process("sky130"), 3_000_000, 10_000
SIGNALS = [signal(net, "input", 300_000 + 100_000 * k, PROCESS) for k, net in enumerate(("clk", "reset"))]


@pytest.fixture(scope="module")
def cells(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pads")
    small.pads(folder)
    return json.loads((folder / "pins.json").read_text())


def made(cells, height, west=900_000, lines=()):
    """(pads, what `ring` gives) of a die of this height with lines of vddr in the west."""
    frame = Frame(WIDTH, height, 15_000, 188_000, 90_000)
    pads = Pads(frame, cells, PROCESS, {"west": west, "east": west})
    return pads, *ring(pads, SIGNALS, [Way("vddr", "west", y, y + LINE) for y in lines])


def taken(pads, places):
    """(low, high, whether a pad) of the cells in the west."""
    boxes = [(pads.box(place), bool(place.nets)) for place in places if place.side == "west"]
    return sorted((box[1], box[3], pad) for box, pad in boxes)


@given(
    height=st.integers(2_400, 6_000).map(UM.__mul__),
    lines=st.lists(st.integers(95, 400), min_size=1, max_size=12).map(lambda all: [10_000 * y for y in all]),
)
def test_a_line_meets_its_own_track_alone(cells, height, lines):
    """Any lines at least two slots apart: no cell is above one, cells and slots fill the side, each pad is there."""
    lines = [
        y for k, y in enumerate(sorted(lines)) if y < height - 400_000 and (not k or y - sorted(lines)[k - 1] > 200_000)
    ]
    pads, places, gaps = made(cells, height, lines=lines)
    slots = sorted((gap.at, gap.at + gap.width) for gap in gaps if not gap.whole)
    assert len(slots) == len(lines)
    assert all(low <= y and y + LINE <= high for (low, high), y in zip(slots, lines, strict=True))
    here, border = taken(pads, places), pads.borders["west"]
    ends = sorted([(low, high) for low, high, _ in here] + slots + [(border, border + GAP)])
    assert all(one[1] == other[0] for one, other in zip(ends, ends[1:]))
    assert sum(pad for *_, pad in here) == len(BESIDE_CHIP) + len(CIRCUITS_ON_SIDE)
    across = [box for _, level, box in bridges(pads, gaps) if level == TOP and box[0] < pads.frame.inner]
    assert not any(box[1] < high and low < box[3] for box in across for low, high in slots)


def test_all_tracks_continue_below_the_top_metal_in_a_slot(cells):
    pads, _, gaps = made(cells, 3_000_000, lines=[1_500_000])
    (slot,) = [gap for gap in gaps if not gap.whole]
    own = [(net, level) for net, level, box in bridges(pads, gaps) if box[1] == slot.at]
    assert {net for net, _ in own} == set(ANALOG.values()) and {level for _, level in own} == {TOP - 1}


def test_only_a_line_with_another_track_before_its_own_has_a_slot(cells):
    pads, *_ = made(cells, 3_000_000)
    assert [net for net in ("vddc", "vssa", "vddr") if pads.crossed(net, "west", 1_500_000)] == ["vddr"]
    assert [net for net in ("vdd", "vss", "vddio") if pads.crossed(net, "west", 500_000)] == ["vddio"]


def test_every_segment_has_a_clamp_of_the_cores_supply(cells):
    """A segment is what lies between two borders; all corners but the south-west and north-west are inside of one."""
    _, places, gaps = made(cells, 3_000_000)
    border = {gap.side: gap.at for gap in gaps if gap.whole}
    clamps = [(place.side, place.at < border[place.side]) for place in places if place.cell == PROCESS.supplies["vdd"]]
    segments = ("west", True), ("west", False), ("east", True), ("east", False)
    assert all(clamps.count(segment) >= 1 for segment in segments) and PROCESS.supplies["vdd"].endswith("Clamp")


def test_a_line_at_the_border_of_two_segments(cells):
    with pytest.raises(NoRoom, match="ring: west_border and slot of vddr overlap in the west, at 916 um"):
        made(cells, 3_000_000, lines=[920_000])


def test_pads_that_the_lines_leave_no_room_for(cells):
    """Six pads of 90 um where every 100 um there is a line."""
    lines = range(1_000_000, 1_700_000, 100_000)
    with pytest.raises(NoRoom, match=r"ring: \S+ and pad_vdd\w_\d overlap in the west, at "):
        made(cells, 1_800_000, lines=lines)
