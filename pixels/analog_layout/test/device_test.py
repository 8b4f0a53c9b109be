"""A drawn transistor has the gates and the junctions that its description says."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from talbot.base.gds import db
from talbot.models.parameters import ParameterError
from talbot.pixels.analog_layout.cells import new_canvas
from talbot.pixels.analog_layout.device import Device, draw_device
from talbot.pixels.circuits.netlist import Transistor
from talbot.platforms.analog import analog_masks
from talbot.platforms.sky130 import analog as process

pytestmark = pytest.mark.needs("layout")

MASKS = analog_masks("sky130")


def transistor(role="n", w=4.0, l=0.25):  # noqa: E741
    return Transistor("m", "d", "g", "s", "vss", role, w, l)


def region(canvas, mask):
    return db.Region(canvas.cell.shapes(canvas.layout.layer(*mask))).merged()


@given(
    st.sampled_from(["n", "p_lvt"]),
    st.sampled_from([0.65, 1.3, 3.0]),
    st.sampled_from([0.15, 0.35, 0.5]),
    st.sampled_from([1, 2, 4, 6]),
    st.booleans(),
    st.booleans(),
)
def test_gates_and_junctions_are_drawn(role, finger, length, fingers, dummies, upright):
    device = Device(transistor(role, finger * fingers, length), fingers, dummies)
    canvas = new_canvas(MASKS, "device")
    straps = draw_device(canvas, MASKS, device, 1.0, 0.0, upright)
    active, poly = region(canvas, MASKS.base.active), region(canvas, MASKS.base.poly)
    gates = active & poly
    assert gates.count() == fingers + 2 * dummies
    assert gates.area() * 1e-6 == pytest.approx((fingers + 2 * dummies) * finger * length)
    source, drain, *_ = device.junctions_um
    shared = 2 * (0.14 + 0.265) * finger if dummies else 0.0  # the dummies' halves and outer ends
    assert (active - poly).area() * 1e-6 == pytest.approx(source + drain + shared)
    assert {strap.net for strap in straps} == {"d", "g", "s"}
    assert all(strap.y * (1 if upright else -1) > 0 for strap in straps)


def test_a_source_on_the_rail_is_marked_and_bad_fingers_are_refused():
    t = transistor()._replace(source="vss")
    straps = draw_device(new_canvas(MASKS, "device"), MASKS, Device(t, 2), 0, 0)
    assert [strap.railed for strap in straps] == [False, False, True]
    with pytest.raises(ParameterError, match="1 or even"):
        Device(transistor(w=3.0), 3)
    with pytest.raises(ParameterError, match="on the grid"):
        Device(transistor(w=1.01), 4)
    assert Device.of(transistor(w=75.0)).fingers == 20  # the fewest of at most 5 um on the grid of 0.005 um


@given(st.sampled_from([1, 2, 4, 16]), st.sampled_from([0.65, 1.37]), st.sampled_from([0.5, 3.3]))
def test_a_circuits_fingers_are_those_that_are_drawn_and_have_their_junctions(fingers, each, length):
    t = transistor("p", round(each * fingers, 6), length)._replace(fingers=fingers)
    device = Device.of(t)
    assert device.fingers == fingers
    line = process.instance(t.name, t.nodes, t.role, t.w, t.l, t.fingers)
    found = {name: float(value) for name, value in re.findall(r"\b(w|m|mult|as|ad|ps|pd)=(\S+)", line)}
    assert found["w"] == pytest.approx(each) and found.get("m", 1) == found.get("mult", 1) == fingers
    junctions = [fingers * found[name] for name in ("as", "ad", "ps", "pd")]
    assert junctions == pytest.approx(device.junctions_um, rel=1e-4)
