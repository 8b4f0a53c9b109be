"""Cover points of AdcBank."""

from rtl.messages import END, FRAME, ROW, SAMPLE


def _taken(p):
    return (p.step__val == 1) & (p.step__rdy == 1) & (p.reset == 0)


def _sent(p):
    return (p.scan__val == 1) & (p.scan__rdy == 1) & (p.reset == 0)


def frame_mark(p):
    return _sent(p) & (p.scan__kind == FRAME)


def row_mark(p):
    return _sent(p) & (p.scan__kind == ROW)


def end_mark(p):
    return _sent(p) & (p.scan__kind == END)


def end_behind_results(p):
    return end_mark(p) & (p.was(_sent(p) & (p.scan__kind == SAMPLE)) == 1)


def all_lanes(p):
    return _taken(p) & (p.step__kind == SAMPLE) & (p.step__en == (1 << p.arguments[0]) - 1)


def one_lane(p):
    return _taken(p) & (p.step__kind == SAMPLE) & (p.step__en > 0) & (p.step__en & (p.step__en - 1) == 0)


def no_lane(p):
    return _taken(p) & (p.step__kind == SAMPLE) & (p.step__en == 0)


def lanes_with_gaps(p):
    return _taken(p) & (p.step__kind == SAMPLE) & (p.step__en & p.step__en >> 2 & ~(p.step__en >> 1) != 0)


def last_of_a_step(p):
    return _sent(p) & (p.scan__kind == SAMPLE) & (p.scan__data >> 9 == 1)


def mode_edge(p):
    return (p.hold == 1) & (p.mode == 0)


def mode_image(p):
    return (p.hold == 1) & (p.mode == 1)


def mode_raw(p):
    return (p.hold == 1) & (p.mode == 2) & (p.sub == 1)


def mode_tof(p):
    return (p.hold == 1) & (p.mode == 3) & (p.sub == 3)


def converts_while_results_leave(p):
    return _sent(p) & (p.scan__kind == SAMPLE) & (p.idle == 0)


def result_waits(p):
    return (p.scan__val == 1) & (p.scan__rdy == 0) & (p.scan__kind == SAMPLE)


def mark_waits(p):
    return (p.scan__val == 1) & (p.scan__rdy == 0) & (p.scan__kind != SAMPLE)


def step_waits(p):
    return (p.step__val == 1) & (p.step__rdy == 0) & (p.reset == 0)


def zeros_counted(p):
    return _sent(p) & (p.left_out > p.was(p.left_out))


def conversions_counted(p):
    return _sent(p) & (p.made > p.was(p.made))


def counts_start_again(p):
    """A second frame."""
    return (p.was(p.made + p.left_out) > 0) & (p.made + p.left_out == 0) & (p.reset == 0) & (p.was(p.reset) == 0)


def idle_with_a_row_to_come(p):
    return (p.idle == 1) & _taken(p) & (p.step__kind == ROW)


def reset_while_converting(p):
    return (p.reset == 1) & (p.idle == 0) & ~p.fresh


def reset_while_results_wait(p):
    return (p.reset == 1) & (p.scan__val == 1) & ~p.fresh
