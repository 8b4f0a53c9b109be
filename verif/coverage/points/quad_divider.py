"""Cover points of the four dividers: they have the same ports."""

import numpy as np

from talbot.verif.coverage.ports import Mask, Points, Recorded, Values


def _signed(values: Values) -> Values:
    return np.where(values > 255, values - 512, values)


def _request(p: Recorded) -> Mask:
    return (p.recv__val == 1) & (p.recv__rdy == 1) & (p.reset == 0)


def _response(p: Recorded) -> Mask:
    return (p.send__val == 1) & (p.send__rdy == 1) & (p.reset == 0)


def _response_waits(p: Recorded) -> Mask:
    return (p.send__val == 1) & (p.send__rdy == 0) & (p.reset == 0)


def _response_waits_long(p: Recorded) -> Mask:
    waits = _response_waits(p)
    return waits & (p.since(~waits) > 3)


def _reset_under_way(p: Recorded) -> Mask:
    """Return the cycles of a reset between a request and its response."""
    ended = p.since(_response(p) | (p.was(p.reset) == 1))
    requested = p.since(_request(p))
    return (
        (p.reset == 1)
        & (p.was(p.reset) == 0)
        & (requested > 0)
        & (requested < 5)
        & ((ended < 0) | (requested < ended))
        & (p.send__val == 0)
    )


POINTS: Points = {
    "octant_0": lambda p: _response(p) & (p.send__octant == 0) & (p.send__zero == 0),
    "octant_1": lambda p: _response(p) & (p.send__octant == 1),
    "octant_2": lambda p: _response(p) & (p.send__octant == 2),
    "octant_3": lambda p: _response(p) & (p.send__octant == 3),
    "octant_4": lambda p: _response(p) & (p.send__octant == 4),
    "octant_5": lambda p: _response(p) & (p.send__octant == 5),
    "octant_6": lambda p: _response(p) & (p.send__octant == 6),
    "octant_7": lambda p: _response(p) & (p.send__octant == 7),
    "zero_vector": lambda p: _response(p) & (p.send__zero == 1),
    "positive_x_axis": lambda p: _request(p) & (p.recv__y == 0) & (_signed(p.recv__x) > 0),
    "negative_x_axis": lambda p: _request(p) & (p.recv__y == 0) & (_signed(p.recv__x) < 0),
    "positive_y_axis": lambda p: _request(p) & (p.recv__x == 0) & (_signed(p.recv__y) > 0),
    "negative_y_axis": lambda p: _request(p) & (p.recv__x == 0) & (_signed(p.recv__y) < 0),
    "diagonal": lambda p: _request(p) & (p.recv__x == p.recv__y) & (p.recv__x != 0),
    "other_diagonal": lambda p: _request(p) & (_signed(p.recv__x) == -_signed(p.recv__y)) & (p.recv__x != 0),
    "most_negative": lambda p: _request(p) & (p.recv__x == 0x100) & (p.recv__y == 0x100),
    "most_positive": lambda p: _request(p) & (p.recv__x == 0xFF) & (p.recv__y == 0xFF),
    # An odd octant's end: the last one counts back from the whole turn.
    "phase_wraps": lambda p: _response(p) & (p.send__octant == 7) & (p.send__phase == 0),
    "amplitude_saturates": lambda p: _response(p) & (p.send__amp == 255) & (p.send__zero == 0),
    "under_the_noise_floor": lambda p: _response(p) & (p.send__amp_valid == 0) & (p.send__zero == 0),
    "at_the_noise_floor": lambda p: _response(p) & (p.send__amp_valid == 1) & (p.send__amp == p.noise_floor),
    "request_waits": lambda p: (p.recv__val == 1) & (p.recv__rdy == 0) & (p.reset == 0),
    "response_waits": _response_waits,
    "response_waits_long": _response_waits_long,
    "idle_without_request": lambda p: (p.recv__val == 0) & (p.recv__rdy == 1) & (p.send__val == 0) & (p.reset == 0),
    "reset_under_way": _reset_under_way,
    "reset_of_a_waiting_response": lambda p: (p.reset == 1) & (p.send__val == 1) & ~p.fresh,
}
