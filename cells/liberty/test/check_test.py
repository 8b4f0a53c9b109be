"""The checker names what a library lacks."""

import numpy as np
import pytest

from talbot.base.liberty.group import Group
from talbot.cells.liberty.check import problems


def table(timing, *kinds):
    for kind in kinds:
        timing.add(kind, "t", index_1=[0.01, 1.0], index_2=[0.001, 0.1], values=np.array([[0.1, 0.2], [0.1, 0.2]]))


def library():
    """A flip-flop with reset, and a tri-state buffer: all that they must have."""
    lib = Group("library", ("l",))
    flop = lib.add("cell", "flop", cell_leakage_power=1.0)
    flop.add("ff", "IQ", "IQ_N", clocked_on="C", next_state="D", clear="!R")
    kinds = {
        "D": ("setup_rising", "hold_rising"),
        "C": (),
        "R": ("recovery_rising", "removal_rising", "min_pulse_width"),
    }
    for name, constraints in kinds.items():
        pin = flop.add("pin", name, direction="input", capacitance=1.0)
        for kind in constraints:
            pin.add("timing", related_pin="C", timing_type=kind)
    timing = flop.add("pin", "Q", direction="output", function="IQ").add(
        "timing", related_pin="C", timing_type="rising_edge"
    )
    table(timing, "cell_rise", "cell_fall")
    buffer = lib.add("cell", "buffer", cell_leakage_power=1.0)
    for name in "AE":
        buffer.add("pin", name, direction="input", capacitance=1.0)
    output = buffer.add("pin", "Z", direction="output", function="A", three_state="!E")
    table(output.add("timing", related_pin="A", timing_type="combinational"), "cell_rise", "cell_fall")
    for kind in ("enable", "disable"):
        output.add("timing", related_pin="E", timing_type=f"three_state_{kind}")
    return lib


def test_what_is_whole_has_no_problem():
    assert problems(library()) == []


@pytest.mark.parametrize(
    "cell, pin, kind, why",
    [
        ("flop", "D", "hold_rising", "flop: D has no hold time"),
        ("flop", "R", "removal_rising", "R has no removal time"),
        ("flop", "R", "min_pulse_width", "R has no shortest pulse"),
        ("flop", "Q", "rising_edge", "Q has no arc from C"),
        ("buffer", "Z", "three_state_disable", "buffer: Z has no three_state_disable from E"),
        ("buffer", "Z", "combinational", "buffer: Z has no arc from A"),
    ],
)
def test_what_is_missing_is_named(cell, pin, kind, why):
    lib = library()
    group = lib.one("cell", cell).one("pin", pin)
    group.groups.remove(group.all("timing", timing_type=kind)[0])
    assert any(problem.endswith(why) for problem in problems(lib))


def test_only_an_output_let_go_may_have_no_slew():
    lib = library()
    output = lib.one("cell", "buffer").one("pin", "Z")
    zero = {"index_1": [0.01, 1.0], "index_2": [0.001, 0.1], "values": np.zeros((2, 2))}
    output.all("timing", timing_type="three_state_disable")[0].add("rise_transition", "t", **zero)
    assert problems(lib) == []
    output.all("timing", timing_type="combinational")[0].add("rise_transition", "t", **zero)
    assert problems(lib) == ["buffer: Z from A: rise_transition is not above 0"]
