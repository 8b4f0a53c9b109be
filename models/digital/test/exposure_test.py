"""The formula of the integration against a row driver that counts the cycles of golden waveforms."""

from dataclasses import replace
from itertools import repeat

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.digital.amp_ctrl import Slot, row_waveform
from talbot.models.digital.exposure import integration_cycles, slot_cycles, windows
from talbot.models.parameters import AmpTiming, FrameParameters, Window

timings = st.builds(AmpTiming, *[st.integers(1, 9)] * 6, n_cm=st.integers(0, 3), exposure=st.integers(0, 7))


def counted(timing, rows):
    """Lengths of the integrations of every row, and the cycle in which each begins, from the pins alone."""
    lead, cycle = timing.exposure, 0
    bits, since, lengths, begins = set(), {}, {row: [] for row in range(rows)}, {}
    for slot in range(rows + lead):
        reset, read = slot if slot < rows else None, slot - lead if slot >= lead else None
        cycle += 1  # of `amp_start`
        row = row_waveform(timing, False, Slot(reset is not None, read is not None, reset is not None and lead > 0))
        pins = next(row)
        for free in repeat(True):
            if pins.expose:
                bits.add(reset)
            if pins.integrate:
                bits.discard(read)
            for number in range(rows):
                high = number in bits or number == read and pins.integrate
                if high and number not in since:
                    since[number] = cycle
                    begins.setdefault(number, cycle)
                elif not high and number in since:
                    lengths[number].append(cycle - since.pop(number))
            cycle += 1
            if pins.done:
                break
            pins = row.send(free)
    return lengths, begins


@settings(max_examples=40, deadline=None)
@given(timings, st.integers(1, 6))
def test_every_row_integrates_as_the_formula_says(timing, rows):
    lengths, begins = counted(timing, rows)
    assert {tuple(found) for found in lengths.values()} == {integration_cycles(timing)}
    starts, span = windows(timing, rows)
    assert [begins[row] - begins[0] for row in range(rows)] == starts
    pauses = timing.n_cm * (timing.t_cm + 2 * timing.t_guard)
    assert span == sum(integration_cycles(timing)) + pauses


def test_by_hand():
    timing = AmpTiming(t_reset=32, t_int=512, t_cm=16, t_settle=16, t_read=16, t_guard=2, n_cm=1, exposure=3)
    assert slot_cycles(timing) == 32 + 2 * 512 + 16 + 32 + 6 * 2 + 2
    assert integration_cycles(timing) == (3 * 1118 + 512, 512)
    assert integration_cycles(replace(timing, exposure=0, n_cm=0)) == (512,)


@pytest.mark.parametrize("mode, rows", [("edge", 5), ("raw", 5), ("tof", 0)])
def test_time_of_flight_has_no_lead(mode, rows):
    frame = FrameParameters(Window(0, 1, 0, 1), mode, timing=AmpTiming(exposure=5))
    assert frame.exposing.exposure == rows
