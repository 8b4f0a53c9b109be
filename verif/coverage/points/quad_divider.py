"""Cover points of the four dividers: they have the same ports."""

import numpy as np


def _signed(values):
    return np.where(values > 255, values - 512, values)


def _asked(p):
    return (p.recv__val == 1) & (p.recv__rdy == 1) & (p.reset == 0)


def _answered(p):
    return (p.send__val == 1) & (p.send__rdy == 1) & (p.reset == 0)


def octant_0(p):
    return _answered(p) & (p.send__octant == 0) & (p.send__zero == 0)


def octant_1(p):
    return _answered(p) & (p.send__octant == 1)


def octant_2(p):
    return _answered(p) & (p.send__octant == 2)


def octant_3(p):
    return _answered(p) & (p.send__octant == 3)


def octant_4(p):
    return _answered(p) & (p.send__octant == 4)


def octant_5(p):
    return _answered(p) & (p.send__octant == 5)


def octant_6(p):
    return _answered(p) & (p.send__octant == 6)


def octant_7(p):
    return _answered(p) & (p.send__octant == 7)


def zero_vector(p):
    return _answered(p) & (p.send__zero == 1)


def positive_x_axis(p):
    return _asked(p) & (p.recv__y == 0) & (_signed(p.recv__x) > 0)


def negative_x_axis(p):
    return _asked(p) & (p.recv__y == 0) & (_signed(p.recv__x) < 0)


def positive_y_axis(p):
    return _asked(p) & (p.recv__x == 0) & (_signed(p.recv__y) > 0)


def negative_y_axis(p):
    return _asked(p) & (p.recv__x == 0) & (_signed(p.recv__y) < 0)


def diagonal(p):
    return _asked(p) & (p.recv__x == p.recv__y) & (p.recv__x != 0)


def other_diagonal(p):
    return _asked(p) & (_signed(p.recv__x) == -_signed(p.recv__y)) & (p.recv__x != 0)


def most_negative(p):
    return _asked(p) & (p.recv__x == 0x100) & (p.recv__y == 0x100)


def most_positive(p):
    return _asked(p) & (p.recv__x == 0xFF) & (p.recv__y == 0xFF)


def phase_wraps(p):
    """An odd octant's end: the last one counts back from the whole turn."""
    return _answered(p) & (p.send__octant == 7) & (p.send__phase == 0)


def amplitude_saturates(p):
    return _answered(p) & (p.send__amp == 255) & (p.send__zero == 0)


def under_the_noise_floor(p):
    return _answered(p) & (p.send__amp_valid == 0) & (p.send__zero == 0)


def at_the_noise_floor(p):
    return _answered(p) & (p.send__amp_valid == 1) & (p.send__amp == p.noise_floor)


def request_waits(p):
    return (p.recv__val == 1) & (p.recv__rdy == 0) & (p.reset == 0)


def response_waits(p):
    return (p.send__val == 1) & (p.send__rdy == 0) & (p.reset == 0)


def response_waits_long(p):
    waits = response_waits(p)
    return waits & (p.since(~waits) > 3)


def idle_without_request(p):
    return (p.recv__val == 0) & (p.recv__rdy == 1) & (p.send__val == 0) & (p.reset == 0)


def reset_under_way(p):
    """A reset behind a request and ahead of its response."""
    ended = p.since(_answered(p) | (p.was(p.reset) == 1))
    asked = p.since(_asked(p))
    return (
        (p.reset == 1)
        & (p.was(p.reset) == 0)
        & (asked > 0)
        & (asked < 5)
        & ((ended < 0) | (asked < ended))
        & (p.send__val == 0)
    )


def reset_of_a_waiting_response(p):
    return (p.reset == 1) & (p.send__val == 1) & ~p.fresh
