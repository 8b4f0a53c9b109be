"""Every cross has a frame; a frame that differs is reported."""

import pytest

from talbot.models.parameters import MODES
from talbot.verif.bench import cross


@pytest.mark.parametrize("seed", range(5))
def test_every_cross_has_a_frame(seed):
    seen = {
        cross.classify(cross.sensor_of(lanes), frame, stall)
        for lanes in cross.ARRAYS
        for frame in cross.frames(lanes, seed)
        for stall in cross.STALLS.values()
    }
    assert seen == cross.every() and len({str(one) for one in seen}) == 5 * 3 * 3 * 2 * 3 * 3
    assert {one.mode for one in seen} == set(MODES)


@pytest.mark.slow
def test_a_wrong_frame_is_named(monkeypatch):
    planned = list(cross.frames(1, 1))[:3]
    assert cross.run(1, 100, planned) is None
    golden, calls = cross.golden_frame, []

    def other(*arguments):
        calls.append(arguments)
        return golden(*arguments[:2], planned[0], arguments[3])

    monkeypatch.setattr(cross, "golden_frame", other)
    assert cross.run(1, 100, planned).startswith(f"frame 1 = {cross.classify(cross.sensor_of(1), planned[1], 100)}: ")
