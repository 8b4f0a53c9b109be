"""Resistances and Elmore delays of planted nets by hand; merged nodes keep them."""

import numpy as np
import pytest

from talbot.signoff.parasitics.test.planted import DEVICES, M1, M2, M3, TECH, VIA, VIA2, planted
from talbot.signoff.parasitics.trees import LEAST_OHM, trees

WIRES = TECH.wires["typ"]
VIAS = [DEVICES.vias[0].lef, *(via.lef for via in TECH.vias)]


def made(found, femtofarad, pins, wires=WIRES):
    boxes = [(found.at(found.names.index(level), *(round(v * 1000) for v in at)), *at) for level, *at in pins]
    points = [(box, round(x * 1000), round(y * 1000)) for box, x, y in boxes]
    return trees(found, np.full(len(found.boxes), femtofarad), wires, VIAS, points, [0])


def to_root(tree, node):
    ohm = 0.0
    while tree.parents[node] >= 0:
        ohm, node = ohm + tree.ohm[node], tree.parents[node]
    return ohm


def elmore(tree):
    """Delay of each pin, ns: each resistor above it times all that is charged through it."""
    through = tree.femtofarad.copy()
    order = np.argsort(tree.distance)
    order = order[np.isfinite(tree.distance[order])]
    for node in order[::-1]:
        if tree.parents[node] >= 0:
            through[tree.parents[node]] += through[node]
    found = np.zeros(len(through))
    for node in order:
        if tree.parents[node] >= 0:
            found[node] = found[tree.parents[node]] + tree.ohm[node] * through[node] * 1e-6
    return found[tree.pins].tolist()


def test_a_line_with_three_pins():
    found = planted((M2, 0, 0, 10, 0.2))
    tree = made(found, 6.0, [("met2", 0, 0.1), ("met2", 4, 0.1), ("met2", 10, 0.1)])
    a_um = WIRES.ohms["met2"] / 0.2
    assert [to_root(tree, node) for node in tree.pins] == pytest.approx([0, 4 * a_um, 10 * a_um])
    assert tree.femtofarad[tree.pins] == pytest.approx([1.2, 3.0, 1.8])
    assert elmore(tree)[2] == pytest.approx((4 * a_um * 4.8 + 6 * a_um * 1.8) * 1e-6)


def test_vias_and_a_branch_that_leads_nowhere():
    boxes = [(M2, 0, 0, 10, 0.2), (VIA2, 9.8, 0, 10, 0.2), (M3, 9.7, -5, 10, 0.2), (M1, 4.9, 0, 5.1, 6)]
    found = planted(*boxes, (VIA, 4.925, 0.025, 5.075, 0.175))
    tree = made(found, 5.0, [("met2", 0, 0.1), ("met3", 9.85, -5)])
    a_um, b_um = WIRES.ohms["met2"] / 0.2, WIRES.ohms["met3"] / 0.3
    expected = 9.9 * a_um + WIRES.ohms["via2"] + 5.1 * b_um
    assert to_root(tree, tree.pins[1]) == pytest.approx(expected)
    assert set(np.flatnonzero(tree.kept)) == set(tree.pins)
    assert tree.femtofarad.sum() == pytest.approx(15.0)


def test_merging_keeps_the_delays_of_all_pins(monkeypatch):
    boxes = [(M2, 0, 0, 20, 0.2), (M2, 5, 0.2, 5.2, 8), (M2, 5.2, 7.8, 9, 8), (M2, 12, -6, 12.2, 0)]
    found = planted(*boxes, (M2, 12.2, -6, 13, -5.8))
    pins = [("met2", 0, 0.1), ("met2", 9, 7.9), ("met2", 20, 0.1), ("met2", 13, -5.9)]
    merged = made(found, 3.0, pins)
    monkeypatch.setattr("talbot.signoff.parasitics.trees._merge", lambda order, parents, *_: parents > -2)
    whole = made(found, 3.0, pins)
    assert elmore(merged) == pytest.approx(elmore(whole), rel=1e-9)
    assert merged.femtofarad.sum() == pytest.approx(whole.femtofarad.sum())
    assert merged.kept.sum() == len(pins) + 2 < len(whole.parents)


def test_of_a_loop_the_better_way_stays():
    ring = [(M2, 0, 0, 10, 0.2), (M2, 0, 0.2, 0.2, 5), (M2, 9.8, 0.2, 10, 5), (M2, 0, 5, 10, 5.2)]
    tree = made(planted(*ring), 1.0, [("met2", 0.1, 2), ("met2", 0.1, 4.9)])
    ohm = 2.9 * WIRES.ohms["met2"] / 0.2
    assert to_root(tree, tree.pins[1]) == pytest.approx(ohm, abs=10 * LEAST_OHM)
    assert tree.femtofarad.sum() == pytest.approx(4.0)
