"""The amplifier control's waveform, cycle by cycle: what AmpCtrl must put on its pins (rtl/amp_ctrl/README.md)."""

from dataclasses import dataclass, fields

import numpy as np

TAPS = 4


@dataclass(frozen=True)
class AmpPins:
    """The outputs of AmpCtrl in one cycle; each 0 or 1, tap 0..3."""

    pixel_reset: int = 0
    shutter: int = 0
    ref_ctl: int = 0
    integrate: int = 0
    cm_reset: int = 0
    read: int = 0
    sample: int = 0
    tap: int = 0
    busy: int = 0
    done: int = 0


PIN_NAMES = tuple(f.name for f in fields(AmpPins))


def row_waveform(timing, four_tap=False):
    """One row from the cycle behind `start` to the cycle of `done`: a generator of AmpPins.

    timing: AmpTiming. It is sent hold_free (bool) of the cycle whose pins it has just yielded; the guard
    before a read lasts until that has been True in its last cycle. Prime it with next().
    """
    for tap in range(TAPS if four_tap else 1):
        yield from _sub_frame(timing, tap)
    yield AmpPins(done=1)


def _sub_frame(t, tap):
    def phase(length, **high):
        for _ in range(length):
            yield AmpPins(tap=tap, busy=1, **high)

    if tap == 0:  # later taps begin in the guard that ended the tap before
        yield from phase(t.t_guard)
    yield from phase(t.t_reset, pixel_reset=1)
    yield from phase(t.t_guard)
    for _ in range(t.n_cm):
        yield from phase(t.t_int, integrate=1, shutter=1)
        yield from phase(t.t_guard, shutter=1)
        yield from phase(t.t_cm, cm_reset=1, shutter=1)
        yield from phase(t.t_guard, shutter=1)
    yield from phase(t.t_int, integrate=1, shutter=1)
    yield from phase(t.t_guard - 1)
    while not (yield AmpPins(tap=tap, busy=1)):
        pass
    for length, reference in ((t.t_settle, 1), (t.t_read, 0)):
        yield from phase(length - 1, read=1, ref_ctl=reference)
        yield AmpPins(tap=tap, busy=1, read=1, ref_ctl=reference, sample=1)
    # The tap counts up behind the guard, long after the second `sample`, into this tap's capacitors, has ended.
    yield from phase(t.t_guard)


def waveform(timing, four_tap, hold_free):
    """One row for a known pattern of hold_free: dict of pin name -> uint8 array, an entry a cycle.

    timing: AmpTiming. hold_free: bools, entry i for the i-th cycle behind `start`. The arrays end with the cycle of
    `done`, or with hold_free if that is shorter.
    """
    row, cycles = row_waveform(timing, four_tap), []
    pins = next(row)
    for free in hold_free:
        cycles.append(pins)
        if pins.done:
            break
        pins = row.send(bool(free))
    table = np.array([list(vars(pins).values()) for pins in cycles], np.uint8).reshape(-1, len(PIN_NAMES))
    return dict(zip(PIN_NAMES, table.T))


def row_cycles(timing, four_tap=False):
    """Cycles from the one behind `start` to the one before `done`, if the hold is free whenever it is asked for."""
    t = timing
    tap = (
        t.t_reset
        + (t.n_cm + 1) * (t.t_int + t.t_guard)
        + t.n_cm * (t.t_cm + t.t_guard)
        + t.t_guard
        + t.t_settle
        + t.t_read
        + t.t_guard
    )
    return t.t_guard + (TAPS if four_tap else 1) * tap
