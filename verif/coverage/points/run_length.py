"""Cover points of RunLength."""

import numpy as np

from rtl.messages import END, FRAME, ROW, SAMPLE


def _in(p):
    return (p.recv__val == 1) & (p.recv__rdy == 1) & (p.reset == 0)


def _out(p):
    return (p.send__val == 1) & (p.send__rdy == 1) & (p.reset == 0)


def _sample(p):
    return _in(p) & (p.recv__kind == SAMPLE) & (p.frame_sync == 1)


def _magnitude(p):
    code = p.recv__data & 0xFF
    return np.where(code > 127, 256 - code, code)


def mode_edge(p):
    return _sample(p) & (p.mode == 0)


def mode_image(p):
    return _sample(p) & (p.mode == 1)


def mode_raw(p):
    return _sample(p) & (p.mode == 2)


def mode_tof(p):
    return _sample(p) & (p.mode == 3) & (p.phase == 0)


def phases(p):
    return _sample(p) & (p.mode == 3) & (p.phase == 1)


def most_negative_code(p):
    return _sample(p) & (p.mode == 0) & (p.recv__data & 0xFF == 0x80)


def most_positive_code(p):
    return _sample(p) & (p.mode == 0) & (p.recv__data & 0xFF == 0x7F)


def code_inside_the_threshold(p):
    return _sample(p) & (p.mode == 0) & (_magnitude(p) < p.threshold) & (_magnitude(p) > 0)


def code_of_the_threshold(p):
    return _sample(p) & (p.mode == 0) & (_magnitude(p) == p.threshold) & (p.threshold > 0)


def threshold_zero(p):
    return _sample(p) & (p.mode == 0) & (p.threshold == 0)


def threshold_highest(p):
    return _sample(p) & (p.mode == 0) & (p.threshold == 127)


def long_run_of_zeros(p):
    other = (_sample(p) & (p.recv__data & 0xFF != 0)) | (_in(p) & (p.recv__kind != SAMPLE))
    return _sample(p) & (p.since(other) > 200)


def a_sample_a_cycle(p):
    return _sample(p) & (p.was(_sample(p)) == 1)


def a_byte_a_cycle(p):
    return _out(p) & (p.was(_out(p)) == 1)


def message_waits(p):
    return (p.recv__val == 1) & (p.recv__rdy == 0) & (p.frame_sync == 1)


def byte_waits(p):
    return (p.send__val == 1) & (p.send__rdy == 0) & (p.reset == 0)


def first_byte_waits(p):
    return byte_waits(p) & (p.frame_sync == 1) & (p.since(p.frame_sync == 0) < 3)


def frames_apart(p):
    return (p.frame_sync == 0) & (p.was(p.frame_sync) == 1) & (p.reset == 0)


def frame_waits_behind_a_frame(p):
    return (p.recv__val == 1) & (p.recv__kind == FRAME) & (p.frame_sync == 1)


def frame_without_rows(p):
    message = _in(p)
    end = message & (p.recv__kind == END)
    return end & (p.frame_sync == 1) & (
        p.since(message & (p.recv__kind == ROW)) > p.since(message & (p.recv__kind == FRAME))
    ) | end & (p.since(message & (p.recv__kind == ROW)) < 0) & (p.frame_sync == 1)


def row_without_samples(p):
    return _in(p) & (p.recv__kind != SAMPLE) & (p.was(_in(p) & (p.recv__kind == ROW)) == 1)


def stray_sample(p):
    return _in(p) & (p.recv__kind == SAMPLE) & (p.frame_sync == 0)


def stray_row(p):
    return _in(p) & (p.recv__kind == ROW) & (p.frame_sync == 0)


def stray_end(p):
    return _in(p) & (p.recv__kind == END) & (p.frame_sync == 0)


def frame_within_a_frame(p):
    return _in(p) & (p.recv__kind == FRAME) & (p.frame_sync == 1)


def sample_ahead_of_the_first_row(p):
    since_row = p.since(_in(p) & (p.recv__kind == ROW))
    since_frame = p.since(_in(p) & (p.recv__kind == FRAME))
    return _sample(p) & (since_frame >= 0) & ((since_row < 0) | (since_row > since_frame))


def made_of_all_bits(p):
    return _out(p) & (p.made == 0xFFFFFFFF)


def left_out_of_all_bits(p):
    return _out(p) & (p.left_out == 0xFFFFFFFF)


def reset_in_a_frame(p):
    return (p.reset == 1) & (p.frame_sync == 1) & ~p.fresh


def reset_while_a_byte_waits(p):
    return (p.reset == 1) & (p.send__val == 1) & ~p.fresh
