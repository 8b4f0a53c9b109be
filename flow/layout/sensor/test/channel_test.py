"""The channel: as few tracks as can be, and in metal the nets that were asked for."""

import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from talbot.base.steps import StepError
from talbot.flow.layout.sensor.channel import check_apart, free, left_edge
from talbot.flow.layout.sensor.plan import DieParameters
from talbot.flow.layout.sensor.routing import STUB, Branch, Tracks, heights
from talbot.flow.layout.sensor.rules import RoutingRules
from talbot.flow.layout.sensor.shapes import signal
from talbot.flow.layout.sensor.test import small
from talbot.platforms.layout import layout_platform

KNOWN = layout_platform("sky130")
ROUTING_RULES = RoutingRules.of(KNOWN, small.RULES)
TRACKS = Tracks.of(ROUTING_RULES, DieParameters())
SPANS = st.dictionaries(
    st.integers(0, 99),
    st.tuples(st.integers(0, 500), st.integers(0, 80)).map(lambda span: (span[0], span[0] + span[1])),
    min_size=1,
    max_size=40,
)


@given(SPANS, st.integers(1, 20))
def test_no_two_on_a_track_come_near_and_none_is_spare(spans, gap):
    tracks = left_edge(spans, gap)
    for one in spans:
        for other in spans:
            if one != other and tracks[one] == tracks[other]:
                assert spans[one][1] + gap <= spans[other][0] or spans[other][1] + gap <= spans[one][0]
    fullest = max(sum(low <= place < high + gap for low, high in spans.values()) for place, _ in spans.values())
    assert len(set(tracks.values())) == max(tracks.values()) + 1 == fullest


@given(st.integers(0, 300), st.lists(st.integers(0, 300), max_size=30), st.integers(1, 20))
def test_a_free_place_is_free_and_the_nearest(wanted, taken, pitch):
    place = free(wanted, taken, pitch)
    assert all(abs(place - other) >= pitch for other in taken)
    assert not any(
        all(abs(wanted + way * d - other) >= pitch for other in taken)
        for d in range(abs(place - wanted))
        for way in (-1, 1)
    )


def test_branches_too_near_are_refused():
    check_apart({("a", "p"): 0, ("b", "q"): 560}, 560)
    with pytest.raises(StepError, match="the pins a p and b q are 550 nm apart in x; 560 nm are needed"):
        check_apart({("b", "q"): 550, ("a", "p"): 0}, 560)


@st.composite
def routes(draw):
    """dict net -> list of Branch: pins from the north, the die's edges and a chip's sides, no two at one x."""
    places = draw(st.lists(st.integers(0, 80), unique=True, min_size=4, max_size=24))
    made = {}
    for k, place in enumerate(places):
        x, net = place * TRACKS.branch_pitch, f"n{k if k < 2 else draw(st.integers(0, len(places) // 2 - 1))}"
        kind = draw(st.sampled_from(("north", "die", "west", "core")))
        row, low = 200_000 + 2000 * k, 15_000 + 2600 * k
        branch = {
            "north": Branch("north", f"p{k}", x, 300_000),
            "die": Branch("die", f"p{k}", x, 0),
            "west": Branch("die", f"p{k}", x, low, (-9_000, low - 280, -6_000, low + 280), "west", STUB),
            "core": Branch("core", f"p{k}", x, row, (100_000, row - 160, 100_300, row + 160)),
        }[kind]
        made.setdefault(net, []).append(branch)
    return made


@settings(deadline=None)
@given(routes())
def test_metal_joins_each_net_and_keeps_others_apart(made):
    try:
        y, _ = heights(made, TRACKS, 20_000)
    except StepError:
        reject()
    shapes = [shape for net, found in made.items() for shape in signal(net, found, y[net], TRACKS, ROUTING_RULES)]
    groups = components(shapes)
    assert len(groups) == len(made)
    assert {frozenset(shapes[k].net for k in group) for group in groups} == {frozenset([net]) for net in made}


def components(shapes):
    """Lists of indices that are connected, metal nearer than its least space included; vias to both layers."""
    numbers = {(wire.layer, wire.datatype): (level, wire.space) for level, wire in enumerate(ROUTING_RULES.layers)}
    cuts = {(cut.layer, cut.datatype): level for level, cut in enumerate(ROUTING_RULES.vias)}
    root = list(range(len(shapes)))

    def find(k):
        while root[k] != k:
            root[k] = root[root[k]]
            k = root[k]
        return k

    def levels(shape):
        at = shape.layer, shape.datatype
        return ({numbers[at][0]}, numbers[at][1]) if at in numbers else ({cuts[at], cuts[at] + 1}, 0)

    known = [levels(shape) for shape in shapes]
    for i, one in enumerate(shapes):
        for j in range(i):
            other, both = shapes[j], known[i][0] & known[j][0]
            near = 0 if 2 in (len(known[i][0]), len(known[j][0])) else known[i][1]
            a, b = one.box, other.box
            if both and a[0] < b[2] + near and b[0] < a[2] + near and a[1] < b[3] + near and b[1] < a[3] + near:
                root[find(i)] = find(j)
    groups = {}
    for k in range(len(shapes)):
        groups.setdefault(find(k), []).append(k)
    return list(groups.values())
