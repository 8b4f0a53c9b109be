"""Cover points of AdcBank."""

from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.verif.coverage.ports import Mask, Points, Recorded


def _taken(p: Recorded) -> Mask:
    return (p.step__val == 1) & (p.step__rdy == 1) & (p.reset == 0)


def _sent(p: Recorded) -> Mask:
    return (p.scan__val == 1) & (p.scan__rdy == 1) & (p.reset == 0)


def _end_mark(p: Recorded) -> Mask:
    return _sent(p) & (p.scan__kind == END)


POINTS: Points = {
    "frame_mark": lambda p: _sent(p) & (p.scan__kind == FRAME),
    "row_mark": lambda p: _sent(p) & (p.scan__kind == ROW),
    "end_mark": _end_mark,
    "end_after_results": lambda p: _end_mark(p) & (p.was(_sent(p) & (p.scan__kind == SAMPLE)) == 1),
    "all_lanes": lambda p: _taken(p) & (p.step__kind == SAMPLE) & (p.step__en == (1 << p.arguments[0]) - 1),
    "one_lane": lambda p: (
        _taken(p) & (p.step__kind == SAMPLE) & (p.step__en > 0) & (p.step__en & (p.step__en - 1) == 0)
    ),
    "no_lane": lambda p: _taken(p) & (p.step__kind == SAMPLE) & (p.step__en == 0),
    "lanes_with_gaps": lambda p: (
        _taken(p) & (p.step__kind == SAMPLE) & (p.step__en & p.step__en >> 2 & ~(p.step__en >> 1) != 0)
    ),
    "last_of_a_step": lambda p: _sent(p) & (p.scan__kind == SAMPLE) & (p.scan__data >> 9 == 1),
    "mode_edge": lambda p: (p.hold == 1) & (p.mode == 0),
    "mode_image": lambda p: (p.hold == 1) & (p.mode == 1),
    "mode_raw": lambda p: (p.hold == 1) & (p.mode == 2) & (p.sub == 1),
    "mode_tof": lambda p: (p.hold == 1) & (p.mode == 3) & (p.sub == 3),
    "mode_ternary": lambda p: (p.hold == 1) & (p.mode == 4),
    "converts_while_results_leave": lambda p: _sent(p) & (p.scan__kind == SAMPLE) & (p.idle == 0),
    "result_waits": lambda p: (p.scan__val == 1) & (p.scan__rdy == 0) & (p.scan__kind == SAMPLE),
    "mark_waits": lambda p: (p.scan__val == 1) & (p.scan__rdy == 0) & (p.scan__kind != SAMPLE),
    "step_waits": lambda p: (p.step__val == 1) & (p.step__rdy == 0) & (p.reset == 0),
    "zeros_counted": lambda p: _sent(p) & (p.left_out > p.was(p.left_out)),
    "conversions_counted": lambda p: _sent(p) & (p.made > p.was(p.made)),
    # A second frame.
    "counts_start_again": lambda p: (
        (p.was(p.made + p.left_out) > 0) & (p.made + p.left_out == 0) & (p.reset == 0) & (p.was(p.reset) == 0)
    ),
    "idle_with_a_row_to_come": lambda p: (p.idle == 1) & _taken(p) & (p.step__kind == ROW),
    "reset_while_converting": lambda p: (p.reset == 1) & (p.idle == 0) & ~p.fresh,
    "reset_while_results_wait": lambda p: (p.reset == 1) & (p.scan__val == 1) & ~p.fresh,
}
