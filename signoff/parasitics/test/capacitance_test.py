"""Closed forms, sum rules and shielding of the capacitances of planted rectangles."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.signoff.parasitics.capacitance import capacitances
from talbot.signoff.parasitics.extract import floating, with_fill_floating
from talbot.signoff.parasitics.test.planted import M1, M2, M3, TECH, VIA, net, planted

TYPICAL = TECH.wires["typ"]
AS_MAGIC = replace(TYPICAL, rate=0.02, screening=0.0, norm=1.0)  # Magic's model: everything adds
CROSSINGS = {(c.upper, c.lower): c for c in TYPICAL.crossings}
EPSILON = 35.4  # aF/um: of SiO2, 4.0


def between(found, all_of_it, a, b):
    """Capacitance of two nets in fF; b: the substrate where None."""
    pair = sorted((a, found.net_count if b is None else b))
    return sum(all_of_it.coupling[(all_of_it.pairs == pair).all(axis=1)])


def test_a_line_over_a_plate_has_its_area_and_its_edges():
    found = planted((M1, -20, -20, 70, 20), (M2, 0, 0, 50, 0.14))
    (got,) = capacitances(found, [TYPICAL])
    c = CROSSINGS["met2", "met1"]
    expected = (50 * 0.14 * c.overlap_af_um2 + 2 * 50.14 * c.down_af_um) / 1000
    plate_edges = between(found, got, net(found, "met1", 0, -10), net(found, "met2", 1, 0.1))
    assert plate_edges == pytest.approx(expected, rel=1e-6)
    assert between(found, got, net(found, "met2", 1, 0.1), None) == 0


@pytest.mark.parametrize("space", [0.14, 0.5, 2.0])
def test_two_lines_couple_by_their_distance(space):
    found = planted((M1, 0, 0, 30, 0.14), (M1, 0, 0.14 + space, 30, 0.28 + space))
    (got,) = capacitances(found, [TYPICAL])
    af, offset = TYPICAL.sidewalls["met1"]
    assert between(found, got, 0, 1) == pytest.approx(30 * af / (space + offset) / 1000, rel=1e-6)
    c = CROSSINGS["met1", "substrate"]
    inner = 2 / np.pi * np.arctan(TYPICAL.rate * c.overlap_af_um2 * space)
    edges = 30 * (1 + inner) + 0.28
    assert between(found, got, 0, None) == pytest.approx((edges * c.down_af_um + 4.2 * c.overlap_af_um2) / 1000, 1e-6)


def test_a_plane_takes_from_the_neighbour_and_from_the_other_plane():
    lines = (M2, 0, 0, 30, 0.14), (M2, 0, 0.64, 30, 0.78)
    below, above = (M1, -20, -20, 50, 20), (M3, -20, -20, 50, 20)
    found = {}
    for name, planes in {"none": (), "below": (below,), "above": (above,), "both": (below, above)}.items():
        shapes = planted(*lines, *planes)
        for model in (TYPICAL, AS_MAGIC):
            (got,) = capacitances(shapes, [model])
            a, b = net(shapes, "met2", 1, 0.1), net(shapes, "met2", 1, 0.7)
            own = float(got.own[shapes.nets == a].sum())
            found[name, model is TYPICAL] = between(shapes, got, a, b), own
    assert found["none", True][0] == pytest.approx(found["none", False][0])
    assert found["both", True][0] < found["below", True][0] < found["none", True][0]
    assert found["both", False][0] == pytest.approx(found["none", False][0])
    assert found["both", True][1] < 0.75 * found["both", False][1]
    assert found["both", True][1] > max(found["below", True][1], found["above", True][1])


def test_a_plate_between_shields():
    found = planted((M1, 0, 0, 10, 0.14), (M2, -10, -10, 20, 10), (M3, 0, 0, 0.3, 10), (M3, 5, 0, 5.3, 10))
    (got,) = capacitances(found, [TYPICAL])
    assert between(found, got, net(found, "met1", 1, 0.1), net(found, "met3", 0.1, 1)) == 0
    assert between(found, got, net(found, "met2", 1, 1), net(found, "met3", 0.1, 1)) > 0


def test_sums_of_pairs_are_the_nets_own_at_every_corner():
    rng = np.random.default_rng(1)
    boxes = []
    for layer in (M1, M2, M3):
        for x, y, w, h in rng.uniform((0, 0, 0.3, 0.3), (20, 20, 8, 2), (25, 4)):
            boxes.append((layer, *np.round((x, y, x + w, y + h), 2)))
    found = planted(*boxes)
    corners = [TECH.wires[name] for name in ("typ", "min", "max")]
    together = capacitances(found, corners)
    for wires, got in zip(corners, together):
        (alone,) = capacitances(found, [wires])
        assert np.allclose(alone.own, got.own)
        totals = np.zeros(found.net_count + 1)
        np.add.at(totals, got.pairs[:, 0], got.coupling)
        np.add.at(totals, got.pairs[:, 1], got.coupling)
        assert np.allclose(np.bincount(found.nets, got.own), totals[:-1])
        assert (got.pairs[:, 0] < got.pairs[:, 1]).all() and (got.coupling >= 0).all()
    typ, least, most = (got.own.sum() for got in together)
    assert least < typ < most


def test_how_a_shape_is_cut_does_not_matter():
    whole = planted((M1, 0, 0, 20, 0.2), (M1, 3, -5, 3.2, 0), (M2, 0, 0.3, 20, 0.5))
    turned = planted((M1, 0, 0, 0.2, 20), (M1, 0.2, 3, 5.2, 3.2), (M2, -0.3, 0, -0.1, 20))
    one, other = (capacitances(found, [TYPICAL])[0].own.sum() for found in (whole, turned))
    assert one == pytest.approx(other, rel=0.01)


def test_fill_adds_and_floats():
    line, squares = (M1, 0, 0, 40, 0.3), [(M1, 2.0 * k, 0.9, 2.0 * k + 1.6, 2.5) for k in range(20)]
    bare, filled = planted(line), planted(line, *squares)
    own = []
    for found in (bare, filled):
        (got,) = capacitances(found, [TYPICAL])
        driven = np.array([net(found, "met1", 1, 0.1)])
        rest = with_fill_floating(found, got, floating(found, driven))
        own += [got.own[found.nets == driven[0]].sum(), rest[found.nets == driven[0]].sum()]
        assert not rest[found.nets != driven[0]].any()
    assert own[0] == own[1] < own[3] < own[2]


def test_what_is_driven_does_not_float():
    found = planted((M1, 0, 0, 10, 0.3), (M1, 0, 0.6, 10, 0.9), (M2, 0, 0.6, 0.3, 0.9), (VIA, 0.1, 0.7, 0.25, 0.85))
    (got,) = capacitances(found, [TYPICAL])
    assert net(found, "met2", 0.1, 0.7) == net(found, "met1", 5, 0.7)
    assert with_fill_floating(found, got, floating(found, np.array([0, 1]))).sum() == pytest.approx(got.own.sum())


@pytest.mark.parametrize(
    "layer, upper, lower, width, thickness, height",
    [(M2, "met2", "met1", 0.14, 0.36, 0.27), (M3, "met3", "met2", 0.3, 0.845, 0.42)],
)
def test_a_single_line_over_a_plane_against_sakurai_and_tamaru(layer, upper, lower, width, thickness, height):
    """[SakuraiTamaru1983], eq. 3. Heights: Magic's sky130.tech."""
    plane = {"met1": M1, "met2": M2}[lower]
    found = planted((plane, -20, -20, 120, 20), (layer, 0, 0, 100, width))
    (got,) = capacitances(found, [TYPICAL])
    a_um = between(found, got, net(found, lower, 0, -10), net(found, upper, 1, width / 2)) * 10
    expected = EPSILON * (1.15 * width / height + 2.80 * (thickness / height) ** 0.222)
    assert a_um == pytest.approx(expected, rel=0.15)
