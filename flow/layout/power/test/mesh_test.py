"""Drops of meshes that can be computed by hand, and of currents far from any real one."""

import numpy as np
import pytest

from talbot.flow.layout.power.mesh import Metal, Tap, drops, metal
from talbot.platforms.layout import layout_platform

METAL = Metal(rail=2.0, strap=0.5, stack=3.0)


def test_one_cell_on_one_rail():
    drop, lost = drops([10.0], [5.0], 20.0, [Tap(0, 9.0, 1e-3)], METAL)
    assert drop[0] == pytest.approx(1e-3 * (4 * 2.0 + 3.0 + 0.5 * 10 / 2))  # rail, stack, both halves of the strap
    assert lost < 1e-12


def test_between_two_straps_the_current_divides():
    drop, _ = drops([10.0], [0.0, 40.0], 20.0, [Tap(0, 10.0, 1e-3)], METAL)
    near, far = 10 * 2.0 + 3.0 + 2.5, 30 * 2.0 + 3.0 + 2.5
    assert drop[0] == pytest.approx(1e-3 * near * far / (near + far))


def test_a_rail_at_the_edge_is_half_as_wide():
    drop, _ = drops([0.0], [5.0], 20.0, [Tap(0, 9.0, 1e-3)], METAL)
    pads = 0.25 * 10.0 / 10.25  # half a um at the near end, the whole strap to the other
    assert drop[0] == pytest.approx(1e-3 * (4 * 2.0 * 2 + 3.0 + pads))


@pytest.mark.parametrize("scale", [1e-15, 1e-6, 1.0, 1e6])
def test_drops_follow_the_current_at_every_scale(scale):
    rng = np.random.default_rng(1)
    taps = [Tap(int(rng.integers(40)), float(rng.uniform(0, 500)), float(rng.uniform(0, 1e-5))) for _ in range(2000)]
    rails, straps = [11.2 * k for k in range(40)], [20.0 + 45 * k for k in range(11)]
    one, lost = drops(rails, straps, 448.0, taps, metal(layout_platform("sky130")))
    more, lost_more = drops(
        rails, straps, 448.0, [Tap(r, x, scale * i) for r, x, i in taps], metal(layout_platform("sky130"))
    )
    assert np.allclose(more, scale * one, rtol=1e-9)
    assert max(lost, lost_more) < 1e-9 and (one > 0).all()


def test_no_current_no_drop():
    drop, lost = drops([0.0, 10.0], [5.0], 20.0, [Tap(1, 9.0, 0.0)], METAL)
    assert drop.tolist() == [0.0] and lost == 0.0
