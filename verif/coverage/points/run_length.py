"""Cover points of RunLength."""

import numpy as np

from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.verif.coverage.ports import Mask, Points, Recorded, Values


def _in(p: Recorded) -> Mask:
    return (p.recv__val == 1) & (p.recv__rdy == 1) & (p.reset == 0)


def _out(p: Recorded) -> Mask:
    return (p.send__val == 1) & (p.send__rdy == 1) & (p.reset == 0)


def _sample(p: Recorded) -> Mask:
    return _in(p) & (p.recv__kind == SAMPLE) & (p.frame_sync == 1)


def _magnitude(p: Recorded) -> Values:
    code = p.recv__data & 0xFF
    return np.where(code > 127, 256 - code, code)


def _long_run_of_zeros(p: Recorded) -> Mask:
    other = (_sample(p) & (p.recv__data & 0xFF != 0)) | (_in(p) & (p.recv__kind != SAMPLE))
    return _sample(p) & (p.since(other) > 200)


def _byte_waits(p: Recorded) -> Mask:
    return (p.send__val == 1) & (p.send__rdy == 0) & (p.reset == 0)


def _frame_without_rows(p: Recorded) -> Mask:
    message = _in(p)
    end = message & (p.recv__kind == END)
    return end & (p.frame_sync == 1) & (
        p.since(message & (p.recv__kind == ROW)) > p.since(message & (p.recv__kind == FRAME))
    ) | end & (p.since(message & (p.recv__kind == ROW)) < 0) & (p.frame_sync == 1)


def _sample_before_the_first_row(p: Recorded) -> Mask:
    since_row = p.since(_in(p) & (p.recv__kind == ROW))
    since_frame = p.since(_in(p) & (p.recv__kind == FRAME))
    return _sample(p) & (since_frame >= 0) & ((since_row < 0) | (since_row > since_frame))


POINTS: Points = {
    "mode_edge": lambda p: _sample(p) & (p.mode == 0),
    "mode_image": lambda p: _sample(p) & (p.mode == 1),
    "mode_raw": lambda p: _sample(p) & (p.mode == 2),
    "mode_tof": lambda p: _sample(p) & (p.mode == 3) & (p.phase == 0),
    "mode_ternary": lambda p: _sample(p) & (p.mode == 4) & (p.recv__data & 0xFF == 0),
    "signs": lambda p: _sample(p) & (p.mode == 4) & (p.recv__data & 0x80 != p.was(p.recv__data) & 0x80),
    "phases": lambda p: _sample(p) & (p.mode == 3) & (p.phase == 1),
    "most_negative_code": lambda p: _sample(p) & (p.mode == 0) & (p.recv__data & 0xFF == 0x80),
    "most_positive_code": lambda p: _sample(p) & (p.mode == 0) & (p.recv__data & 0xFF == 0x7F),
    "code_inside_the_threshold": lambda p: (
        _sample(p) & (p.mode == 0) & (_magnitude(p) < p.threshold) & (_magnitude(p) > 0)
    ),
    "code_of_the_threshold": lambda p: _sample(p) & (p.mode == 0) & (_magnitude(p) == p.threshold) & (p.threshold > 0),
    "threshold_zero": lambda p: _sample(p) & (p.mode == 0) & (p.threshold == 0),
    "threshold_highest": lambda p: _sample(p) & (p.mode == 0) & (p.threshold == 127),
    "long_run_of_zeros": _long_run_of_zeros,
    **{f"resync_{n}": lambda p, n=n: _sample(p) & (p.resync == n) for n in range(4)},
    "a_sample_a_cycle": lambda p: _sample(p) & (p.was(_sample(p)) == 1),
    "a_byte_a_cycle": lambda p: _out(p) & (p.was(_out(p)) == 1),
    "message_waits": lambda p: (p.recv__val == 1) & (p.recv__rdy == 0) & (p.frame_sync == 1),
    "byte_waits": _byte_waits,
    "first_byte_waits": lambda p: _byte_waits(p) & (p.frame_sync == 1) & (p.since(p.frame_sync == 0) < 3),
    "frames_apart": lambda p: (p.frame_sync == 0) & (p.was(p.frame_sync) == 1) & (p.reset == 0),
    "frame_waits_after_a_frame": lambda p: (p.recv__val == 1) & (p.recv__kind == FRAME) & (p.frame_sync == 1),
    "frame_without_rows": _frame_without_rows,
    "row_without_samples": lambda p: _in(p) & (p.recv__kind != SAMPLE) & (p.was(_in(p) & (p.recv__kind == ROW)) == 1),
    "stray_sample": lambda p: _in(p) & (p.recv__kind == SAMPLE) & (p.frame_sync == 0),
    "stray_row": lambda p: _in(p) & (p.recv__kind == ROW) & (p.frame_sync == 0),
    "stray_end": lambda p: _in(p) & (p.recv__kind == END) & (p.frame_sync == 0),
    "frame_within_a_frame": lambda p: _in(p) & (p.recv__kind == FRAME) & (p.frame_sync == 1),
    "sample_before_the_first_row": _sample_before_the_first_row,
    "made_of_all_bits": lambda p: _out(p) & (p.made == 0xFFFFFFFF),
    "left_out_of_all_bits": lambda p: _out(p) & (p.left_out == 0xFFFFFFFF),
    "reset_in_a_frame": lambda p: (p.reset == 1) & (p.frame_sync == 1) & ~p.fresh,
    "reset_while_a_byte_waits": lambda p: (p.reset == 1) & (p.send__val == 1) & ~p.fresh,
}
