"""Nets are joined from pin to pin around others, and every rule is kept."""

import random

import pytest

from flow.layout.geometry.test.gate import gate
from flow.layout.route.board import Board
from flow.layout.route.negotiate import negotiate
from flow.layout.route.nets import route_net
from flow.layout.route.rules import RoutingRules
from flow.layout.route.violations import Violations, find, split_levels
from platforms.coriolis import coriolis_platform

db = pytest.importorskip("klayout.db", reason="klayout: not installed; make layout installs it")

TECH = coriolis_platform("sky130")
LIBRARY_RULES = {
    "metals": {
        "li": {"width": 0.17, "space": 0.17, "area": 0},
        "m1": {"width": 0.14, "space": 0.14, "area": 0.083},
        "m2": {"width": 0.14, "space": 0.14, "area": 0.0676},
        "m3": {"width": 0.3, "space": 0.3, "area": 0.24},
        "m4": {"width": 0.3, "space": 0.3, "area": 0.24},
    },
    "vias": {
        "mcon": {"below": [0, 0], "above": [0.03, 0.06]},
        "via": {"below": [0.055, 0.085], "above": [0.055, 0.085]},
        "via2": {"below": [0.04, 0.085], "above": [0.065, 0.065]},
        "via3": {"below": [0.06, 0.09], "above": [0.065, 0.065]},
    },
}
RULES = RoutingRules.of(TECH, LIBRARY_RULES)
SIDE = 40_000


def empty():
    layout = db.Layout()
    top = layout.create_cell("top")
    top.shapes(layout.layer(235, 4)).insert(db.Box(0, 0, SIDE, SIDE))
    return layout, top


def draw(layout, top, level, *box):
    layer = RULES.layers[level]
    top.shapes(layout.layer(layer.layer, layer.datatype)).insert(db.Box(*box))


def pin(layout, top, x, y):
    """A cell's pin, drawn: its boxes."""
    box = x - 85, y - 1500, x + 85, y + 1500
    draw(layout, top, 0, *box)
    return [(0, *box)]


def nets(layout, top, points):
    """Numbers of the nets at (level, x, y), of the layers."""
    l2n, layers = db.LayoutToNetlist(db.RecursiveShapeIterator(layout, top, [])), []
    for level, layer in enumerate(RULES.layers):
        layers.append(l2n.make_layer(layout.layer(layer.layer, layer.datatype), layer.name))
        l2n.connect(layers[-1])
        if level:
            via = RULES.vias[level - 1]
            vias = l2n.make_layer(layout.layer(via.layer, via.datatype), via.name)
            for other in (vias, layers[-1], layers[-2]):
                l2n.connect(vias, other)
    l2n.extract_netlist()
    return [l2n.probe_net(layers[level], db.Point(x, y)).cluster_id for level, x, y in points]


def broken(layout, top):
    """Violations of width, space and area by rule."""
    found = {}
    for layer in RULES.layers[1:]:
        region = db.Region(top.begin_shapes_rec(layout.layer(layer.layer, layer.datatype))).merged()
        found |= {
            f"{layer.name} space": region.space_check(layer.space).count(),
            f"{layer.name} width": region.width_check(layer.width).count(),
            f"{layer.name} area": region.with_area(0, layer.area, False).count(),
        }
    return {rule: number for rule, number in found.items() if number}


def um(boxes):
    """A pin's boxes as coriolis.dump has them."""
    return [[RULES.layers[level].name, *(value / 1000 for value in box)] for level, *box in boxes]


def alone(pins, jumpers=False, layout=None):
    """The layout with one net routed between ``pins``; None without a path."""
    board = Board(layout, RULES, {"w1": {"segments": [], "vias": [], "pins": list(map(um, pins))}})
    found = route_net(board, "w1", jumpers)
    if found is None:
        return None, None
    board.put("w1", found.route)
    return board.drawn(), found.route


def test_two_pins_with_nothing_between():
    layout, top = empty()
    pins = [pin(layout, top, 5_000, 5_000), pin(layout, top, 30_015, 20_000)]
    assert len(set(nets(layout, top, [(0, 5_000, 5_000), (0, 30_015, 20_000)]))) == 2
    layout, _ = alone(pins, layout=layout)
    first, second = nets(layout, layout.top_cell(), [(0, 5_000, 5_000), (0, 30_015, 20_000)])
    assert first == second
    assert broken(layout, layout.top_cell()) == {}


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("jumpers", [False, True])
def test_through_congestion(seed, jumpers):
    rng = random.Random(seed)
    layout, top = empty()
    pins = [pin(layout, top, 85 * rng.randrange(40, 430), 5 * rng.randrange(800, 7000)) for _ in range(4)]
    for track in range(0, SIDE - 700, 680):
        for level, half in ((1, 70), (2, 70), (3, 150), (4, 150)):
            start = rng.randrange(0, 25_000)
            ends = start, start + rng.randrange(1_000, 12_000)
            if rng.random() < 0.6:
                box = (ends[0], track - half, ends[1], track + half)
                draw(layout, top, level, *(box if RULES.layers[level].horizontal else (box[1], box[0], box[3], box[2])))
    before = broken(layout, top)
    layout, route = alone(pins, jumpers, layout)
    if route is None:
        assert jumpers  # there may be no room for a jumper
        return
    points = [(0, (p[0][1] + p[0][3]) // 2, (p[0][2] + p[0][4]) // 2) for p in pins]
    assert len(set(nets(layout, layout.top_cell(), points))) == 1
    assert broken(layout, layout.top_cell()) == before
    if jumpers:
        assert route.lengths[4] >= 1_500


def walls(layout, top, *xs):
    """Walls through all layers, of no net."""
    for level in (1, 2, 3, 4):
        for x in xs:
            draw(layout, top, level, x, 0, x + 400, SIDE)


def test_a_pin_behind_a_wall_is_given_up():
    layout, top = empty()
    pins = [pin(layout, top, 5_000, 5_000), pin(layout, top, 30_000, 30_000)]
    walls(layout, top, 20_000)
    assert alone(pins, layout=layout) == (None, None)


def test_a_net_without_a_path_is_ripped_up():
    layout, top = empty()
    boxes = [pin(layout, top, 5_000, 5_000), pin(layout, top, 30_000, 30_000)]
    walls(layout, top, 20_000)
    draw(layout, top, 1, 4_930, 4_930, 6_000, 5_070)
    shapes = {"w1": {"segments": [["m1", 4.93, 4.93, 6.0, 5.07]], "vias": [], "pins": list(map(um, boxes))}}
    board = Board(layout, RULES, shapes)
    assert board.boxes["w1"] == [("m1", (4_930, 4_930, 6_000, 5_070))]
    found = negotiate(board, ["w1"])
    assert (found.open, found.routes, board.boxes["w1"]) == (["w1"], {}, [])


def test_a_net_in_the_way_is_evicted():
    """A hall of two walls with a gap, which another net fills with segments on all layers; it has room elsewhere."""
    layout, top = empty()
    pins = {
        "w1": [pin(layout, top, 5_000, 20_000), pin(layout, top, 35_020, 20_000)],
        "w2": [pin(layout, top, 18_020, 30_000), pin(layout, top, 22_015, 10_000)],
    }
    for level in (1, 2, 3, 4):
        draw(layout, top, level, 20_000, 0, 20_400, 18_000)
        draw(layout, top, level, 20_000, 21_500, 20_400, SIDE)
    rows = range(17_000, 23_000, 680)
    segments = [
        [RULES.layers[level].name, 19.0, (y - 150) / 1000, 21.0, (y + 150) / 1000]
        for level in (1, 2, 3, 4)
        for y in rows
        if 18_300 < y < 21_200
    ]
    for name, *box in segments:
        draw(layout, top, [layer.name for layer in RULES.layers].index(name), *(round(1000 * v) for v in box))
    shapes = {
        net: {"segments": segments if net == "w2" else [], "vias": [], "pins": list(map(um, made))}
        for net, made in pins.items()
    }
    board = Board(layout, RULES, shapes)
    found = negotiate(board, ["w1"])
    assert found.open == [] and set(found.routes) == {"w1", "w2"}
    drawn = board.drawn()
    assert broken(drawn, drawn.top_cell()) == {}
    first, second, third, fourth = nets(
        drawn, drawn.top_cell(), [(0, 5_000, 20_000), (0, 35_020, 20_000), (0, 18_020, 30_000), (0, 22_015, 10_000)]
    )
    assert first == second != third == fourth


def test_a_board_draws_what_it_lifted():
    layout, top = empty()
    pins = [pin(layout, top, 5_000, 5_000), pin(layout, top, 30_015, 20_000)]
    layout, route = alone(pins, layout=layout)
    segments = [
        [RULES.layers[level].name, *(v / 1000 for v in box)] for level, made in route.segments.items() for box in made
    ]
    vias = [
        ["_".join((RULES.layers[level].name, RULES.vias[level].name, RULES.layers[level + 1].name)), x / 1000, y / 1000]
        for level, made in route.vias.items()
        for x, y in made
    ]
    area = {
        layer.name: db.Region(layout.top_cell().begin_shapes_rec(layout.layer(layer.layer, layer.datatype))).area()
        for layer in RULES.layers
    }
    assert area["m1"] > 0 and area["m2"] > 0
    board = Board(layout, RULES, {"w1": {"segments": segments, "vias": vias, "pins": list(map(um, pins))}})
    assert board.top.shapes(board.layers["m2"]).size() == 0
    drawn = board.drawn()
    assert area == {
        layer.name: db.Region(drawn.top_cell().begin_shapes_rec(drawn.layer(layer.layer, layer.datatype))).area()
        for layer in RULES.layers
    }
    assert find(drawn, RULES, TECH) == Violations()


def test_nets_that_are_too_near_or_have_an_antenna():
    """w0 and w2 lead to gates, w0 too far; w2 is too near to w1. A part of the layout has the same as the whole."""
    layout, top = empty()
    cell = gate(layout, TECH)
    for y in (5_000, 30_000):
        top.insert(db.CellInstArray(cell.cell_index(), db.Trans(db.Vector(1_000, y))))
    segments = {
        "w0": (1_300, 4_200, 61_000, 4_500),
        "w1": (5_000, 29_600, 9_000, 29_900),
        "w2": (1_300, 29_200, 9_000, 29_500),
    }
    for box in segments.values():
        draw(layout, top, 1, *box)
    board = Board(
        layout,
        RULES,
        {
            net: {"segments": [["m1", *(v / 1000 for v in box)]], "vias": [], "pins": []}
            for net, box in segments.items()
        },
    )
    whole = find(board.drawn(), RULES, TECH)
    assert whole.nets(board) == (["w1"], ["w0"])
    assert whole.nets(board, ["w2"]) == (["w2"], [])
    for net in segments:
        assert find(board.part([net]), RULES, TECH).nets(board, [net]) == whole.nets(board, [net])
    parts = [find(board.drawn(), RULES, TECH, levels) for levels in split_levels(RULES, 2)]
    assert sum(parts, Violations()).nets(board) == (["w1"], ["w0"])
