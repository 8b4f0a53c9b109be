"""Cover points of EdgeAdc."""

import numpy as np


def go_from_idle(p):
    return (p.go == 1) & (p.busy == 0) & (p.reset == 0)


def go_in_the_last_decision(p):
    """The next value is sampled while the last bit is decided."""
    return (p.go == 1) & (p.busy == 1) & (p.was(p.free) == 1) & (p.reset == 0)


def go_that_is_ignored(p):
    return (p.go == 1) & (p.busy == 1) & (p.was(p.free) == 0) & (p.reset == 0)


def _taken(p):
    return (p.out__val == 1) & (p.out__rdy == 1) & (p.reset == 0)


def zero_by_the_window(p):
    return _taken(p) & (p.converted == 0) & (p.unsigned_ == 0)


def zero_by_the_search(p):
    """A code that the search put inside the window, or on zero."""
    return _taken(p) & (p.converted == 1) & (p.out__msg == 0) & (p.unsigned_ == 0) & (p.threshold > 0)


def least_magnitude(p):
    """A code of the threshold's own size."""
    return _taken(p) & (p.unsigned_ == 0) & (p.threshold > 0) & (p.out__msg == p.threshold)


def least_magnitude_negative(p):
    return _taken(p) & (p.unsigned_ == 0) & (p.threshold > 0) & (p.out__msg == 256 - p.threshold)


def lowest_signed(p):
    return _taken(p) & (p.unsigned_ == 0) & (p.out__msg == 0x80)


def highest_signed(p):
    return _taken(p) & (p.unsigned_ == 0) & (p.out__msg == 0x7F)


def lowest_unsigned(p):
    return _taken(p) & (p.unsigned_ == 1) & (p.out__msg == 0)


def highest_unsigned(p):
    return _taken(p) & (p.unsigned_ == 1) & (p.out__msg == 0xFF)


def threshold_zero(p):
    return _taken(p) & (p.unsigned_ == 0) & (p.threshold == 0)


def threshold_highest(p):
    return _taken(p) & (p.unsigned_ == 0) & (p.threshold == 127)


def result_waits(p):
    return (p.out__val == 1) & (p.out__rdy == 0) & (p.reset == 0)


def conversion_behind_a_waiting_result(p):
    return result_waits(p) & (p.busy == 1)


def second_result_waits(p):
    """A whole search behind a result that is not taken."""
    blocked = (p.out__val == 1) & (p.out__rdy == 0) & (p.busy == 1)
    return blocked & (p.since(~blocked) > 12)


def results_back_to_back(p):
    """A result takes the place of the one that leaves in the same cycle."""
    return (p.out__val == 1) & p.was(_taken(p)).astype(bool)


def reset_while_converting(p):
    return (p.reset == 1) & (p.busy == 1) & ~p.fresh


def free_falls_with_room_used(p):
    return (p.free == 0) & (p.was(p.free) == 1) & (p.reset == 0)


def window_above(p):
    """The first decision of a window says that the value is not below T."""
    return (
        (p.was(p.go) == 1) & (p.comparator == 1) & (p.dac == (p.threshold | 0x80)) & (p.threshold > 0) & (p.busy == 1)
    )


def window_below(p):
    return (p.was(p.go, 2) == 1) & (p.comparator == 0) & (p.dac == np.where(p.threshold > 0, 129 - p.threshold, -1))
