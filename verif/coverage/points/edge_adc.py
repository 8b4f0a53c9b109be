"""Cover points of EdgeAdc."""

import numpy as np

from talbot.verif.coverage.ports import Mask, Points, Recorded


def _taken(p: Recorded) -> Mask:
    return (p.out__val == 1) & (p.out__rdy == 1) & (p.reset == 0)


def _result_waits(p: Recorded) -> Mask:
    return (p.out__val == 1) & (p.out__rdy == 0) & (p.reset == 0)


def _second_result_waits(p: Recorded) -> Mask:
    """Return the cycles in which a search ends while a result waits."""
    blocked = (p.out__val == 1) & (p.out__rdy == 0) & (p.busy == 1)
    return blocked & (p.since(~blocked) > 12)


POINTS: Points = {
    "go_from_idle": lambda p: (p.go == 1) & (p.busy == 0) & (p.reset == 0),
    # The next value is sampled while the last bit is decided.
    "go_in_the_last_decision": lambda p: (p.go == 1) & (p.busy == 1) & (p.was(p.free) == 1) & (p.reset == 0),
    "go_that_is_ignored": lambda p: (p.go == 1) & (p.busy == 1) & (p.was(p.free) == 0) & (p.reset == 0),
    "zero_by_the_window": lambda p: _taken(p) & (p.converted == 0) & (p.unsigned_ == 0) & (p.ternary == 0),
    # A code that the search put inside the window, or on zero.
    "zero_by_the_search": lambda p: (
        _taken(p) & (p.converted == 1) & (p.out__msg == 0) & (p.unsigned_ == 0) & (p.threshold > 0)
    ),
    # A code of the threshold's own size.
    "least_magnitude": lambda p: _taken(p) & (p.unsigned_ == 0) & (p.threshold > 0) & (p.out__msg == p.threshold),
    "least_magnitude_negative": lambda p: (
        _taken(p) & (p.unsigned_ == 0) & (p.threshold > 0) & (p.out__msg == 256 - p.threshold)
    ),
    "lowest_signed": lambda p: _taken(p) & (p.unsigned_ == 0) & (p.out__msg == 0x80),
    "highest_signed": lambda p: _taken(p) & (p.unsigned_ == 0) & (p.out__msg == 0x7F),
    "lowest_unsigned": lambda p: _taken(p) & (p.unsigned_ == 1) & (p.out__msg == 0),
    "highest_unsigned": lambda p: _taken(p) & (p.unsigned_ == 1) & (p.out__msg == 0xFF),
    "threshold_zero": lambda p: _taken(p) & (p.unsigned_ == 0) & (p.threshold == 0),
    "threshold_highest": lambda p: _taken(p) & (p.unsigned_ == 0) & (p.threshold == 127),
    **{
        f"ternary_{name}": lambda p, code=code: _taken(p) & (p.ternary == 1) & (p.out__msg == code)
        for name, code in (("below", 0xFF), ("zero", 0), ("above", 1))
    },
    "ternary_threshold_zero": lambda p: _taken(p) & (p.ternary == 1) & (p.threshold == 0),
    "ternary_result_waits": lambda p: _second_result_waits(p) & (p.ternary == 1),
    "result_waits": _result_waits,
    "conversion_after_a_waiting_result": lambda p: _result_waits(p) & (p.busy == 1),
    "second_result_waits": _second_result_waits,
    # A result takes the place of the one that leaves in the same cycle.
    "results_back_to_back": lambda p: (p.out__val == 1) & p.was(_taken(p)).astype(bool),
    "reset_while_converting": lambda p: (p.reset == 1) & (p.busy == 1) & ~p.fresh,
    "free_falls_with_room_used": lambda p: (p.free == 0) & (p.was(p.free) == 1) & (p.reset == 0),
    # The first decision of a window says that the value is not below T.
    "window_above": lambda p: (
        (p.was(p.go) == 1) & (p.comparator == 1) & (p.dac == (p.threshold | 0x80)) & (p.threshold > 0) & (p.busy == 1)
    ),
    "window_below": lambda p: (
        (p.was(p.go, 2) == 1) & (p.comparator == 0) & (p.dac == np.where(p.threshold > 0, 129 - p.threshold, -1))
    ),
}
