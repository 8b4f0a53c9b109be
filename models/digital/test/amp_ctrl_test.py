"""The golden waveform against what the specification says of it, by other means than counting it out again."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.digital.amp_ctrl import PIN_NAMES, row_cycles, waveform
from talbot.models.parameters import AmpTiming

PHASES = ("pixel_reset", "integrate", "cm_reset", "read")
timings = st.builds(AmpTiming, *[st.integers(1, 9)] * 6, n_cm=st.integers(0, 4))
patterns = st.lists(st.booleans(), max_size=300).map(lambda free: free + [True] * 1000)


def pulses(pin):
    """Rising edges and lengths of the pulses of a pin: two int arrays."""
    steps = np.diff(pin.astype(int), prepend=0, append=0)
    rise = np.flatnonzero(steps == 1)
    return rise, np.flatnonzero(steps == -1) - rise


def sequence(pins):
    """(first cycle, cycles, name) of every phase, in time order."""
    return sorted((int(rise), int(length), name) for name in PHASES for rise, length in zip(*pulses(pins[name])))


@settings(max_examples=60, deadline=None)
@given(timings, st.booleans(), patterns)
def test_phases_in_order_with_a_guard_between_any_two(timing, four_tap, hold_free):
    pins = waveform(timing, four_tap, hold_free)
    assert max(sum(pins[name].astype(int) for name in PHASES)) == 1
    row = sequence(pins)
    integrate = [("integrate", timing.t_int)]
    sub_frame = [
        ("pixel_reset", timing.t_reset),
        *(integrate + [("cm_reset", timing.t_cm)]) * timing.n_cm,
        *integrate,
        ("read", timing.t_settle + timing.t_read),
    ]
    assert [(name, length) for _, length, name in row] == sub_frame * (4 if four_tap else 1)
    previous_end = 0
    for start, length, name in row:
        if name == "read":
            assert start - previous_end >= timing.t_guard and hold_free[start - 1]
            assert not any(hold_free[previous_end + timing.t_guard - 1 : start - 1])
        else:
            assert start - previous_end == timing.t_guard
        previous_end = start + length
    assert pins["done"].nonzero()[0].tolist() == [previous_end + timing.t_guard] == [len(pins["done"]) - 1]
    assert pins["busy"][:-1].all() and not pins["busy"][-1]


@settings(max_examples=60, deadline=None)
@given(timings, st.booleans(), patterns)
def test_shutter_reference_samples_and_taps(timing, four_tap, hold_free):
    pins = waveform(timing, four_tap, hold_free)
    reads, opened = pulses(pins["read"])[0], pulses(pins["shutter"])
    first = pulses(pins["integrate"])[0][:: timing.n_cm + 1]
    assert opened[0].tolist() == first.tolist()
    exposure = (timing.n_cm + 1) * timing.t_int + timing.n_cm * (timing.t_cm + 2 * timing.t_guard)
    assert set(opened[1]) == {exposure}
    reference = reads[:, None] + np.arange(timing.t_settle)
    assert pins["ref_ctl"].nonzero()[0].tolist() == reference.ravel().tolist()
    strobes = np.stack([reads + timing.t_settle - 1, reads + timing.t_settle + timing.t_read - 1], 1)
    assert pins["sample"].nonzero()[0].tolist() == strobes.ravel().tolist()
    assert pins["tap"][strobes[:, 0]].tolist() == list(range(4 if four_tap else 1))
    changes = np.flatnonzero(np.diff(pins["tap"].astype(int), append=0)) + 1
    assert set(changes) <= {*pulses(pins["pixel_reset"])[0], len(pins["tap"]) - 1}


@pytest.mark.parametrize("four_tap", [False, True])
def test_cycles_of_a_row(four_tap):
    for timing in (AmpTiming(), AmpTiming(1, 1, 1, 1, 1, 1, 0), AmpTiming(7, 11, 3, 5, 2, 4, 9)):
        cycles = row_cycles(timing, four_tap)
        assert len(waveform(timing, four_tap, [True] * (cycles + 99))["done"]) == cycles + 1


def test_ends_with_the_pattern():
    pins = waveform(AmpTiming(2, 3, 1, 1, 1, 1, 0), False, [False] * 40)
    assert list(pins) == list(PIN_NAMES) and all(len(pin) == 40 for pin in pins.values())
    assert not pins["read"].any() and pins["busy"].all()
    assert len(waveform(AmpTiming(), False, [])["busy"]) == 0


def test_waveform_by_hand():
    pins = waveform(AmpTiming(2, 3, 1, 2, 1, 1, n_cm=1), False, [True] * 19)
    drawn = {
        "pixel_reset": "0110000000000000000",
        "shutter": "0000111111111000000",
        "integrate": "0000111000111000000",
        "cm_reset": "0000000010000000000",
        "read": "0000000000000011100",
        "ref_ctl": "0000000000000011000",
        "sample": "0000000000000001100",
        "busy": "1111111111111111110",
        "done": "0000000000000000001",
    }
    assert {name: "".join(map(str, pins[name])) for name in drawn} == drawn
