"""Waveform of the amplifier control, cycle by cycle: the values on the pins of AmpCtrl (rtl/amp_ctrl/README.md)."""

from collections.abc import Generator, Iterable
from dataclasses import dataclass, fields

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import AmpTiming

TAPS = 4


@dataclass(frozen=True)
class AmpPins:
    """Outputs of AmpCtrl in one cycle; each 0 or 1, tap 0..3."""

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
    expose: int = 0


PIN_NAMES = tuple(f.name for f in fields(AmpPins))

Waveform = Generator[AmpPins, bool, None]


@dataclass(frozen=True)
class Slot:
    """The actions of one run of AmpCtrl; its duration does not depend on them.

    resets: it resets a row of pixels.
    reads: it ends the integration of a row and reads it.
    opens: the row that it resets is read in a later slot: it integrates from `expose` on.
    """

    resets: bool = True
    reads: bool = True
    opens: bool = False


def row_waveform(timing: AmpTiming, four_tap: bool = False, slot: Slot = Slot()) -> Waveform:
    """Pins of one row from the cycle after `start` to the cycle of `done`.

    The generator expects hold_free (bool) of the cycle whose pins it has just yielded; the guard before a read lasts
    until hold_free is True in its last cycle. Prime it with next().

    timing: durations of the phases. four_tap: four sub-frames, one per time-of-flight tap, instead of one. slot: what
    is left out of the row. Yields AmpPins: of each cycle.
    """
    for tap in range(TAPS if four_tap else 1):
        yield from _sub_frame(timing, tap, slot)
    yield AmpPins(done=1)


def _sub_frame(t: AmpTiming, tap: int, slot: Slot) -> Waveform:
    on = {"pixel_reset": slot.resets, "expose": slot.opens and tap == 0}

    def pins(**high: int) -> AmpPins:
        return AmpPins(
            tap=tap, busy=1, **{name: level if on.get(name, slot.reads) else 0 for name, level in high.items()}
        )

    def phase(length: int, **high: int) -> Waveform:
        for _ in range(length):
            yield pins(**high)

    def integrate(first: bool) -> Waveform:
        yield pins(integrate=1, shutter=1, expose=int(first))
        yield from phase(t.t_int - 1, integrate=1, shutter=1)

    if tap == 0:  # later taps begin in the guard that ends the tap before
        yield from phase(t.t_guard)
    yield from phase(t.t_reset, pixel_reset=1)
    yield from phase(t.t_guard)
    yield from integrate(first=True)
    for _ in range(t.n_cm):
        yield from phase(t.t_guard, shutter=1)
        yield from phase(t.t_cm, cm_reset=1, shutter=1)
        yield from phase(t.t_guard, shutter=1)
        yield from integrate(first=False)
    yield from phase(t.t_guard - 1)
    while not (yield pins()):
        pass
    for length, reference in ((t.t_settle, 1), (t.t_read, 0)):
        yield from phase(length - 1, read=1, ref_ctl=reference)
        yield pins(read=1, ref_ctl=reference, sample=1)
    # The tap counts up after the guard, long after the end of the second `sample` into this tap's capacitors.
    yield from phase(t.t_guard)


def waveform(
    timing: AmpTiming, four_tap: bool, hold_free: Iterable[bool], slot: Slot = Slot()
) -> dict[str, npt.NDArray[np.uint8]]:
    """Pins of one row for a known pattern of hold_free.

    timing: durations of the phases. four_tap: four sub-frames instead of one. hold_free: entry i belongs to the i-th
    cycle after `start`. slot: what is left out of the row. Returns pin name to one value per cycle, up to the cycle of
    `done` or the end of ``hold_free``.
    """
    row, cycles = row_waveform(timing, four_tap, slot), []
    pins = next(row)
    for free in hold_free:
        cycles.append(pins)
        if pins.done:
            break
        pins = row.send(bool(free))
    table = np.array([list(vars(pins).values()) for pins in cycles], np.uint8).reshape(-1, len(PIN_NAMES))
    return dict(zip(PIN_NAMES, table.T))


def row_cycles(timing: AmpTiming, four_tap: bool = False) -> int:
    """Cycles from the one after `start` to the one before `done`, if hold_free is always True.

    timing: durations of the phases. four_tap: four sub-frames instead of one. Returns cycles of a row.
    """
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
