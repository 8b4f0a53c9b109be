"""Cover points of PhasePath."""

from rtl.messages import END, FRAME, ROW, SAMPLE


def _in(p):
    return (p.recv__val == 1) & (p.recv__rdy == 1) & (p.reset == 0)


def _out(p):
    return (p.send__val == 1) & (p.send__rdy == 1) & (p.reset == 0)


def samples_pass_when_off(p):
    return _out(p) & (p.on == 0) & (p.send__kind == SAMPLE)


def marks_pass_when_off(p):
    return _out(p) & (p.on == 0) & (p.send__kind == END)


def a_message_a_cycle_when_off(p):
    return _in(p) & _out(p) & (p.on == 0)


def frame_when_on(p):
    return _out(p) & (p.on == 1) & (p.send__kind == FRAME)


def row_when_on(p):
    return _out(p) & (p.on == 1) & (p.send__kind == ROW)


def end_when_on(p):
    return _out(p) & (p.on == 1) & (p.send__kind == END)


def end_waits_for_the_divider(p):
    """END is taken, and a sample leaves behind it."""
    return _out(p) & (p.on == 1) & (p.send__kind == SAMPLE) & (p.since(_in(p) & (p.recv__kind == END)) > 0)


def step_of_one_sample(p):
    return (
        _in(p)
        & (p.on == 1)
        & (p.recv__kind == SAMPLE)
        & (p.recv__data >> 9 == 1)
        & (p.was(_in(p) & (p.recv__kind == SAMPLE) & (p.recv__data >> 9 == 1)) == 1)
    )


def step_of_several_samples(p):
    return _in(p) & (p.on == 1) & (p.recv__kind == SAMPLE) & (p.recv__data >> 9 == 0)


def amplitude_suppressed(p):
    """A zero behind a phase that is none."""
    sample = _out(p) & (p.on == 1) & (p.send__kind == SAMPLE)
    return sample & (p.noise_floor > 0) & (p.send__data == 0)


def amplitude_high(p):
    return _out(p) & (p.on == 1) & (p.send__kind == SAMPLE) & (p.send__data == 255)


def noise_floor_zero(p):
    return _out(p) & (p.on == 1) & (p.send__kind == SAMPLE) & (p.noise_floor == 0)


def input_waits(p):
    return (p.recv__val == 1) & (p.recv__rdy == 0) & (p.reset == 0)


def result_waits(p):
    return (p.send__val == 1) & (p.send__rdy == 0) & (p.on == 1) & (p.send__kind == SAMPLE)


def mark_waits(p):
    return (p.send__val == 1) & (p.send__rdy == 0) & (p.on == 1) & (p.send__kind != SAMPLE)


def passing_sample_waits(p):
    return (p.send__val == 1) & (p.send__rdy == 0) & (p.on == 0) & (p.send__kind == SAMPLE)


def reset_with_a_message_inside(p):
    return (p.reset == 1) & (p.send__val == 1) & ~p.fresh


def reset_in_a_step(p):
    taken = _in(p) & (p.on == 1) & (p.recv__kind == SAMPLE)
    return (p.reset == 1) & (p.was(taken) == 1)
