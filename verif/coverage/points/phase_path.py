"""Cover points of PhasePath."""

from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.verif.coverage.ports import Mask, Points, Recorded


def _in(p: Recorded) -> Mask:
    return (p.recv__val == 1) & (p.recv__rdy == 1) & (p.reset == 0)


def _out(p: Recorded) -> Mask:
    return (p.send__val == 1) & (p.send__rdy == 1) & (p.reset == 0)


def _amplitude_suppressed(p: Recorded) -> Mask:
    """Return the cycles of an amplitude of 0 after a phase that is not valid."""
    sample = _out(p) & (p.on == 1) & (p.send__kind == SAMPLE)
    return sample & (p.noise_floor > 0) & (p.send__data == 0)


def _reset_in_a_step(p: Recorded) -> Mask:
    taken = _in(p) & (p.on == 1) & (p.recv__kind == SAMPLE)
    return (p.reset == 1) & (p.was(taken) == 1)


def _after(p: Recorded, event: Mask) -> Mask:
    """Return the cycles after ``event`` without a reset since."""
    event_at, reset_at = p.since(event), p.since(p.reset == 1)
    return (event_at > 0) & ((reset_at < 0) | (event_at < reset_at))


def _begins(p: Recorded, on: int) -> Mask:
    return _in(p) & (p.on == on) & (p.recv__kind == FRAME)


def _ended(p: Recorded, on: int) -> Mask:
    return _out(p) & (p.on == on) & (p.send__kind == END)


POINTS: Points = {
    "samples_pass_when_off": lambda p: _out(p) & (p.on == 0) & (p.send__kind == SAMPLE),
    "marks_pass_when_off": lambda p: _out(p) & (p.on == 0) & (p.send__kind == END),
    "a_message_a_cycle_when_off": lambda p: _in(p) & _out(p) & (p.on == 0),
    "frame_when_on": lambda p: _out(p) & (p.on == 1) & (p.send__kind == FRAME),
    "row_when_on": lambda p: _out(p) & (p.on == 1) & (p.send__kind == ROW),
    "end_when_on": lambda p: _out(p) & (p.on == 1) & (p.send__kind == END),
    # END is taken, and a sample leaves after it.
    "end_waits_for_the_divider": lambda p: (
        _out(p) & (p.on == 1) & (p.send__kind == SAMPLE) & (p.since(_in(p) & (p.recv__kind == END)) > 0)
    ),
    "phase_after_a_frame_without": lambda p: _begins(p, 1) & _after(p, _ended(p, 0)),
    "without_phase_after_a_frame": lambda p: _begins(p, 0) & _after(p, _ended(p, 1)),
    "noise_floor_changes_between_frames": lambda p: (
        _begins(p, 1) & _after(p, _ended(p, 1)) & _after(p, p.was(p.noise_floor) != p.noise_floor)
    ),
    "step_of_one_sample": lambda p: (
        _in(p)
        & (p.on == 1)
        & (p.recv__kind == SAMPLE)
        & (p.recv__data >> 9 == 1)
        & (p.was(_in(p) & (p.recv__kind == SAMPLE) & (p.recv__data >> 9 == 1)) == 1)
    ),
    "step_of_several_samples": lambda p: _in(p) & (p.on == 1) & (p.recv__kind == SAMPLE) & (p.recv__data >> 9 == 0),
    "amplitude_suppressed": _amplitude_suppressed,
    "amplitude_high": lambda p: _out(p) & (p.on == 1) & (p.send__kind == SAMPLE) & (p.send__data == 255),
    "noise_floor_zero": lambda p: _out(p) & (p.on == 1) & (p.send__kind == SAMPLE) & (p.noise_floor == 0),
    "input_waits": lambda p: (p.recv__val == 1) & (p.recv__rdy == 0) & (p.reset == 0),
    "result_waits": lambda p: (p.send__val == 1) & (p.send__rdy == 0) & (p.on == 1) & (p.send__kind == SAMPLE),
    "mark_waits": lambda p: (p.send__val == 1) & (p.send__rdy == 0) & (p.on == 1) & (p.send__kind != SAMPLE),
    "passing_sample_waits": lambda p: (p.send__val == 1) & (p.send__rdy == 0) & (p.on == 0) & (p.send__kind == SAMPLE),
    "reset_with_a_message_inside": lambda p: (p.reset == 1) & (p.send__val == 1) & ~p.fresh,
    "reset_in_a_step": _reset_in_a_step,
}
