"""Nets are joined from pin to pin around others, and every rule is kept."""

import random
from collections import Counter
from itertools import pairwise

import klayout.db as db
import numpy as np
import pytest

from talbot.flow.layout.geometry.boxes import corners
from talbot.flow.layout.geometry.instances import insert
from talbot.flow.layout.geometry.test.gate import gate
from talbot.flow.layout.netlist.netlist import Instance, Netlist, with_diodes
from talbot.flow.layout.route.board import Board
from talbot.flow.layout.route.diodes import Diodes
from talbot.flow.layout.route.negotiate import HELD, negotiate, route, straighten
from talbot.flow.layout.route.nets import clear_of, route_net
from talbot.flow.layout.route.route import Route
from talbot.flow.layout.route.rules import RoutingRules
from talbot.flow.layout.route.view import NetView
from talbot.flow.layout.route.violations import Violations, find, split_levels
from talbot.platforms.coriolis import coriolis_platform

pytestmark = pytest.mark.needs("layout")

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
    for via in RULES.vias:
        region = db.Region(top.begin_shapes_rec(layout.layer(via.layer, via.datatype))).merged()
        found[f"{via.name} space"] = region.space_check(via.space).count()
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


def alone(pins, layout):
    """The layout with one net routed between ``pins``; None without a path."""
    board = Board(layout, RULES, {"w1": {"segments": [], "vias": [], "pins": list(map(um, pins))}})
    found = route_net(board, "w1")
    if found is None:
        return None, None
    board.put("w1", found.route)
    return board.drawn(), found.route


def test_two_pins_with_nothing_between():
    layout, top = empty()
    pins = [pin(layout, top, 5_000, 5_000), pin(layout, top, 30_015, 20_000)]
    assert len(set(nets(layout, top, [(0, 5_000, 5_000), (0, 30_015, 20_000)]))) == 2
    layout, _ = alone(pins, layout)
    first, second = nets(layout, layout.top_cell(), [(0, 5_000, 5_000), (0, 30_015, 20_000)])
    assert first == second
    assert broken(layout, layout.top_cell()) == {}


@pytest.mark.parametrize("seed", range(6))
def test_through_congestion(seed):
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
    layout, _ = alone(pins, layout)
    points = [(0, (p[0][1] + p[0][3]) // 2, (p[0][2] + p[0][4]) // 2) for p in pins]
    assert len(set(nets(layout, layout.top_cell(), points))) == 1
    assert broken(layout, layout.top_cell()) == before


def walls(layout, top, *xs):
    """Walls through all layers, of no net."""
    for level in (1, 2, 3, 4):
        for x in xs:
            draw(layout, top, level, x, 0, x + 400, SIDE)


def test_a_pin_behind_a_wall_is_given_up():
    layout, top = empty()
    pins = [pin(layout, top, 5_000, 5_000), pin(layout, top, 30_000, 30_000)]
    walls(layout, top, 20_000)
    assert alone(pins, layout) == (None, None)


def test_without_room_for_the_least_area_the_way_is_another():
    """In a pen with two ways up through m3, the nearer too narrow for a piece of that layer."""
    layout, top = empty()
    dx, dy = RULES.step
    at = db.Point(70 * dx, 60 * dy), db.Point(30_000, 30_000)
    pins = [pin(layout, top, point.x, point.y) for point in at]
    inside, outside = db.Box(5_000, 5_000, 15_000, 15_000), db.Box(4_600, 4_600, 15_400, 15_400)
    narrow, wide = db.Box(1_000, 1_000).moved(at[0].x, at[0].y), db.Box(4_000, 4_000).moved(8_000, 8_000)
    holes = {1: [inside], 2: [inside], 3: [narrow, wide]}
    for level, boxes in holes.items():
        for part in (db.Region(outside) - db.Region(boxes)).decompose_trapezoids():
            draw(layout, top, level, *corners(part.bbox()))
    layout, _ = alone(pins, layout)
    assert layout is not None
    assert len(set(nets(layout, layout.top_cell(), [(0, point.x, point.y) for point in at]))) == 1
    assert broken(layout, layout.top_cell()) == {}


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


@pytest.mark.parametrize("light", ["w2", "w3"])
def test_of_two_nets_in_the_way_the_lighter_one_is_evicted(light):
    """A wall with two gaps, each filled by a net; the one that was routed more often costs more."""
    layout, top = empty()
    pins = {"w1": [pin(layout, top, 5_000, 20_000), pin(layout, top, 35_020, 20_000)]}
    gaps = {"w2": 12_000, "w3": 28_000}
    for net, y in gaps.items():
        pins[net] = [pin(layout, top, x, y) for x in (15_015, 25_030)]
    for level in (1, 2, 3, 4):
        for bottom, end in ((0, 11_000), (13_000, 27_000), (29_000, SIDE)):
            draw(layout, top, level, 20_000, bottom, 20_400, end)
    shapes = {net: {"segments": [], "vias": [], "pins": list(map(um, made))} for net, made in pins.items()}
    board = Board(layout, RULES, shapes)
    for net, y in gaps.items():
        rows = [(19_000, at - 150, 21_000, at + 150) for at in range(y - 600, y + 601, 600)]
        board.put(net, Route(dict.fromkeys((1, 2, 3, 4), rows), {}), 1 if net == light else 5)
    assert {net: board.price(net) for net in gaps} == {net: board.present * (1 if net == light else 5) for net in gaps}
    assert route_net(board, "w1", False).evicted == {light}


def hall():
    """Two nets whose straight ways cross in a hall without room for both."""
    layout, top = empty()
    pins = {
        "w1": [pin(layout, top, 5_000, 20_000), pin(layout, top, 35_020, 20_000)],
        "w2": [pin(layout, top, 12_035, 20_000), pin(layout, top, 28_015, 20_000)],
    }
    for level in (1, 2, 3, 4):
        for bottom, end in ((12_000, 19_100), (20_900, 28_000)):
            draw(layout, top, level, 20_000, bottom, 20_400, end)
    shapes = {net: {"segments": [], "vias": [], "pins": list(map(um, made))} for net, made in pins.items()}
    return Board(layout, RULES, shapes)


def test_a_net_that_may_not_be_much_longer_is_dear_to_evict():
    """w1 bears 30 um more than its least length, w2 half a um."""
    board = hall()
    diodes = Diodes([], db.Layout(), db.Layout(), {}, TECH)
    state = route(board, ["w1", "w2"], TECH, diodes, {"w1": 60.0, "w2": 16.6})
    assert state.tight == {"w2"} and board.weights == {"w1": 1, "w2": HELD}
    assert board.price("w2") == HELD * board.price("w1")


def bent():
    """The nets of the hall, of which the first was routed around the second."""
    board = hall()
    rows = [(19_000, at - 150, 21_000, at + 150) for at in range(19_400, 20_601, 300)]
    board.put("w2", Route(dict.fromkeys((1, 2, 3, 4), rows), {}), 50)
    state = negotiate(board, ["w1"])
    assert state.evictions == 0
    board.put("w2", Route(), 1)
    return board, negotiate(board, ["w2"], state)


def lengths(state):
    return {net: made.nm / 1000 for net, made in state.routes.items()}


def test_a_net_that_is_too_long_gets_straight():
    board, state = bent()
    before = lengths(state)
    assert before["w1"] > 40  # um, between pins 30 um apart
    assert straighten(board, state, {"w1": 35.0}) == set()
    assert lengths(state)["w1"] < 35 and not state.open
    drawn = board.drawn()
    assert broken(drawn, drawn.top_cell()) == {}
    first, second, third, fourth = nets(
        drawn, drawn.top_cell(), [(0, 5_000, 20_000), (0, 35_020, 20_000), (0, 12_035, 20_000), (0, 28_015, 20_000)]
    )
    assert first == second != third == fourth


def test_a_net_that_bears_its_length_stays():
    board, state = bent()
    before = dict(state.routes)
    assert straighten(board, state, {"w1": 100.0}) == set()
    assert all(state.routes[net] is made for net, made in before.items())


def test_where_others_would_be_too_long_all_stays():
    """The hall has no room for both, and the other net bears no detour either."""
    board, state = bent()
    assert straighten(board, state, {"w1": 35.0}) == set()
    before, boxes = dict(state.routes), dict(board.boxes)
    most = {"w1": before["w1"].nm / 1000, "w2": before["w2"].nm / 1000 - 5}
    assert straighten(board, state, most) == {"w2"}
    assert sum(made.nm / 1000 - most[net] for net, made in state.routes.items()) <= 5.001
    assert {net for net, made in before.items() if state.routes[net] is not made} in (set(), {"w1", "w2"}, {"w2"})
    assert boxes.keys() == board.boxes.keys() and all(board.boxes.values())


def test_a_board_draws_what_it_lifted():
    layout, top = empty()
    pins = [pin(layout, top, 5_000, 5_000), pin(layout, top, 30_015, 20_000)]
    layout, route = alone(pins, layout)
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
    own = (1_400, 5_000, 1_550, 5_500)  # w0's gate
    assert whole.nets(board) == (["w1"], [("w0", own)])
    assert whole.nets(board, ["w2"]) == (["w2"], [])
    for net in segments:
        assert find(board.part([net]), RULES, TECH).nets(board, [net]) == whole.nets(board, [net])
    parts = [find(board.drawn(), RULES, TECH, levels) for levels in split_levels(RULES, 2)]
    assert sum(parts, Violations()).nets(board) == (["w1"], [("w0", own)])


@pytest.mark.parametrize("off", [(0, 30), (170, 5), (145, 145), (200, 100)])
def test_vias_that_overlap_or_are_too_near(off):
    """Of one net, whose metal covers both; a via twice at one place is one."""
    layout, top = empty()
    (dx, dy), via = off, RULES.vias[2]
    draw(layout, top, 2, 4_000, 4_000, 6_000, 6_000)
    draw(layout, top, 3, 4_000, 4_000, 6_000, 6_000)
    for x, y in ((4_500, 4_500), (4_500, 4_500), (4_500 + dx, 4_500 + dy)):
        top.shapes(layout.layer(via.layer, via.datatype)).insert(db.Box(x, y, x + via.size, y + via.size))
    box = ["m2", 4.0, 4.0, 6.0, 6.0], ["m3", 4.0, 4.0, 6.0, 6.0]
    board = Board(layout, RULES, {"w1": {"segments": list(box), "vias": [], "pins": []}})
    assert find(board.drawn(), RULES, TECH).nets(board) == (["w1"], [])


def library():
    """A layout of the cells that fill rows and of the diode, two sites and one wide; their areas, the diode's pin."""
    made = db.Layout()
    for name in TECH.fill_cells:
        made.create_cell(name)
    diode = made.create_cell("diode_w1")
    for layer in (TECH.active, TECH.contact, TECH.metals[0].gds):
        diode.shapes(made.layer(*layer)).insert(db.DBox(0.175, 0.435, 0.345, 1.905))
    sites = {"tie": 1, "tie_w2": 2, "tie_w4": 4, "tie_w8": 8, "diode_w1": 1}
    areas = {name: count * TECH.site_um * TECH.row_um for name, count in sites.items()}
    return made, areas, {"diode_w1": {"i": [["li", 0.175, 0.435, 0.345, 1.905]]}}


@pytest.mark.parametrize("room", [True, False])
def test_an_antenna_gets_a_diode_where_there_is_fill(room):
    layout, top = empty()
    top.shapes(layout.layer(235, 4)).insert(db.Box(0, 0, 10 * SIDE, SIDE))
    top.insert(db.CellInstArray(gate(layout, TECH).cell_index(), db.Trans(db.Vector(5_000, 5_000))))
    cells, areas, masters = library()
    rows = (3.12, "6"), (3.12, "0"), (9.36, "6")  # two begin at the same height
    placed = [[None, "tie_w8", 9.36 + 4.16 * k, *row] for k in range(3) for row in rows]
    for _, cell, *place in placed:
        insert(top, cells, cell, *place)
    far = pin(layout, top, 350_030, 36_000)
    pins = [[["m1", 5.3, 4.2, 5.7, 4.5]], um(far)]
    others = {f"w{k}": {"segments": [], "vias": [], "pins": []} for k in range(2, 10)}
    board = Board(layout, RULES, {"w1": {"segments": [], "vias": [], "pins": pins}} | others)
    diodes = Diodes(placed if room else [], masters, cells, areas, TECH)
    found = route(board, ["w1"], TECH, diodes)
    drawn = board.drawn()
    assert found.open == [] and diodes.nets == ["w1"] * room
    assert bool(find(drawn, RULES, TECH).antennas) != room
    assert broken(drawn, drawn.top_cell()) == {}
    names = Counter(instance.cell.name for instance in drawn.top_cell().each_inst())
    widths = {name: area / TECH.row_um for name, area in areas.items()}
    taken = Counter()
    for instance in (one for one in drawn.top_cell().each_inst() if one.cell.name != "gate"):
        taken[instance.dtrans.disp.y, instance.dtrans.is_mirror()] += widths[instance.cell.name]
    assert taken == pytest.approx({(y, turn == "6"): 3 * widths["tie_w8"] for y, turn in rows})
    assert names["diode_w1"] == room
    reference = with_diodes(
        Netlist("", (), tuple(Instance("", place[1], {}) for place in placed)), ["w1"] * room, diodes.fill
    )
    del names["gate"]
    assert Counter(instance.cell for instance in reference.instances) == +names
    if room:
        trans = next(i.dtrans for i in drawn.top_cell().each_inst() if i.cell.name == "diode_w1")
        end, inside = trans.disp, trans * db.DPoint(0.26, 1.0)
        assert abs(end.x - 9.36) < 0.1  # beside the gate, not at the far end
        ends = [(1, 5_500, 4_350), (0, round(1000 * inside.x), round(1000 * inside.y))]
        assert len(set(nets(drawn, drawn.top_cell(), [*ends, (0, 350_030, 36_000)]))) == 1


@pytest.mark.parametrize("seed", range(4))
def test_the_legs_that_stay_are_joined_again(seed):
    """Of a net with six pins every leg is taken away in turn, then half of them: the others stay where they are."""
    rng = random.Random(seed)
    layout, top = empty()
    at = [(85 * rng.randrange(40, 430), 5 * rng.randrange(800, 7000)) for _ in range(6)]
    pins = [pin(layout, top, *point) for point in at]
    board = Board(layout, RULES, {"w1": {"segments": [], "vias": [], "pins": list(map(um, pins))}})
    whole = route_net(board, "w1")
    assert len(whole.legs) == 5 and set().union(*(leg.pins for leg in whole.legs)) == set(range(6))
    for lost in ([0], [1], [2], [3], [4], [0, 2, 4], [1, 3]):
        kept = [leg for k, leg in enumerate(whole.legs) if k not in lost]
        found = route_net(board, "w1", kept=kept)
        assert found.legs[: len(kept)] == tuple(kept)
        board.put("w1", found.route)
        drawn = board.drawn()
        board.rip_up("w1")
        points = [(0, (p[0][1] + p[0][3]) // 2, (p[0][2] + p[0][4]) // 2) for p in pins]
        assert len(set(nets(drawn, drawn.top_cell(), points))) == 1
        assert broken(drawn, drawn.top_cell()) == {}


def test_legs_are_clear_of_another_route():
    layout, top = empty()
    pins = [pin(layout, top, x, 20_000) for x in (5_000, 20_000, 35_020)]
    board = Board(layout, RULES, {"w1": {"segments": [], "vias": [], "pins": list(map(um, pins))}})
    legs = route_net(board, "w1").legs
    ends = [(level, box) for level, made in legs[1].route.segments.items() for box in made]
    level, box = max(ends, key=lambda end: end[1][0])  # the farthest from the first leg
    beside = Route({level: [(box[0], box[3] + RULES.layers[level].space - 5, box[2], box[3] + 1_000)]})
    far = Route({level: [(box[0], box[3] + 5_000, box[2], box[3] + 6_000)]})
    assert clear_of(legs, beside, board) == [legs[0]]
    assert clear_of(legs, far, board) == []  # in the way is what no leg is


def test_a_leg_goes_with_that_by_which_it_meets_a_pin():
    """A diode's leg begins where another leg meets the gate; without that one it would end there."""
    layout, top = empty()
    at = (5_015, 20_000), (35_020, 20_000), (7_990, 20_000)
    pins = [pin(layout, top, *point) for point in at]
    board = Board(layout, RULES, {"w1": {"segments": [], "vias": [], "pins": list(map(um, pins[:2]))}})
    trunk = route_net(board, "w1").legs
    board.add_diode("w1", um(pins[2]), 0)
    legs = route_net(board, "w1", kept=trunk).legs
    assert [leg.pins for leg in legs] == [{0, 1}, {0, 2}]
    ends = [(level, box) for level, made in trunk[0].route.segments.items() for box in made]
    level, box = max(ends, key=lambda end: end[1])
    kept = clear_of(legs, Route({level: [box]}), board)
    board.put("w1", route_net(board, "w1", kept=kept).route)
    drawn = board.drawn()
    assert len(set(nets(drawn, drawn.top_cell(), [(0, *point) for point in at]))) == 1


def test_what_is_too_long_for_a_diode_gets_a_jumper():
    """345 um of one layer beside a gate of 0.075 um2."""
    layout, top = empty()
    top.shapes(layout.layer(235, 4)).insert(db.Box(0, 0, 10 * SIDE, SIDE))
    top.insert(db.CellInstArray(gate(layout, TECH).cell_index(), db.Trans(db.Vector(5_000, 5_000))))
    cells, areas, masters = library()
    placed = [[None, "tie_w8", 9.36, 3.12, "0"]]
    insert(top, cells, *placed[0][1:])
    others = {f"w{k}": {"segments": [], "vias": [], "pins": []} for k in range(2, 10)}
    pins = [[["m1", 5.3, 4.2, 5.7, 4.5]], um(pin(layout, top, 350_030, 5_000))]
    board = Board(layout, RULES, {"w1": {"segments": [], "vias": [], "pins": pins}} | others)
    diodes = Diodes(placed, masters, cells, areas, TECH)
    found = route(board, ["w1"], TECH, diodes)
    drawn = board.drawn()
    assert found.open == [] and diodes.nets == ["w1"] and board.jumpers["w1"] == {0}
    assert find(drawn, RULES, TECH) == Violations()
    assert broken(drawn, drawn.top_cell()) == {}
    assert len(set(nets(drawn, drawn.top_cell(), [(1, 5_500, 4_350), (0, 350_030, 5_000), (0, 9_620, 4_000)]))) == 1


def test_a_jumper_is_not_made_past_legs_that_stay():
    """A trunk beside a gate: a jumper would have to go round it, and may not be able to."""
    layout, top = empty()
    top.shapes(layout.layer(235, 4)).insert(db.Box(0, 0, 10 * SIDE, SIDE))
    top.insert(db.CellInstArray(gate(layout, TECH).cell_index(), db.Trans(db.Vector(170_000, 5_000))))
    ends = [um(pin(layout, top, x, 4_300)) for x in (5_015, 350_030)]
    others = {f"w{k}": {"segments": [], "vias": [], "pins": []} for k in range(2, 10)}
    own = {"segments": [], "vias": [], "pins": [*ends, [["m1", 170.3, 4.2, 170.7, 4.5]]]}
    trunk = route_net(Board(layout.dup(), RULES, {"w1": own | {"pins": ends}}), "w1").legs
    board = Board(layout, RULES, {"w1": own} | others)
    board.jumpers["w1"].add(2)
    found = route_net(board, "w1", kept=trunk)
    assert found.legs[0].pins == {2}  # the jumper is the first
    board.put("w1", found.route)
    drawn = board.drawn()
    assert find(drawn, RULES, TECH) == Violations()
    assert len(set(nets(drawn, drawn.top_cell(), [(1, 170_500, 4_350), (0, 5_015, 4_300), (0, 350_030, 4_300)]))) == 1


def test_vias_of_a_net_keep_apart():
    """A way up beside a via of the same net goes elsewhere, or where that is."""
    layout, _ = empty()
    board = Board(layout, RULES, {"w1": {"segments": [], "vias": [], "pins": []}})
    view = NetView(board, 0)
    source, target = (1, 100, 100), (2, 101, 140)
    used = board.grid.used.copy()
    view.hold(np.array([(1, 100, 101), (2, 100, 101)]))
    path = board.grid.search(0, (0, 0, SIDE, SIDE), [source], [target])
    (via,) = [one for one, other in pairwise(path) if one[0] != other[0]]
    view.release()
    dx, dy = (abs(via[axis + 1] - (100, 101)[axis]) * RULES.step[axis] for axis in (0, 1))
    least = RULES.vias[1].size + RULES.vias[1].space
    assert dx >= least or dy >= least or (dx, dy) == (0, 0)
    assert (board.grid.used == used).all()
    path = board.grid.search(0, (0, 0, SIDE, SIDE), [(1, 101, 101)], [(2, 101, 140)])
    assert path[1] == (2, 101, 101)  # else straight up
