"""Reset: without a clock edge it has no effect; with one, at any cycle, it ends all, and the next frame is right."""

import numpy as np
import pytest

from talbot.models.digital.host import command, read_transfer
from talbot.models.digital.stream import decode_stream
from talbot.models.parameters.registers import register_map
from talbot.verif.faults.chip import FRAMES, configured, golden, quiet, resets, run, start
from talbot.verif.faults.waveform import (
    BUSY,
    HOLD,
    MISO,
    PULSE_HIGH,
    PULSE_LOW,
    RESET,
    SYNC,
    VAL,
    rest,
    status_wave,
    transfer,
)

CHIP = register_map()
HELD = resets()
READ_ALL = read_transfer(min(HELD), max(HELD) - min(HELD) + 1)
DEFAULTS = bytes(HELD.get(a, 0) for a in range(min(HELD), max(HELD) + 1))


@pytest.mark.parametrize("name", FRAMES)
@pytest.mark.parametrize("pulse", [PULSE_LOW, PULSE_HIGH], ids=["clock low", "clock high"])
def test_a_reset_without_a_clock_edge_is_nothing(name, pulse):
    """Pulses between the edges of every cycle: not one output of one cycle differs."""
    quiet_trace = quiet(name).trace
    (trace,) = run([quiet_trace.wave | np.uint8(pulse)])
    assert np.array_equal(trace.out, quiet_trace.out)


@pytest.mark.parametrize("name", FRAMES)
def test_reset_for_one_cycle_at_any_cycle_of_a_frame(name):
    """Every output is at rest from the next cycle on, the registers are at their resets, the next frame is right."""
    frame, wave = quiet(name), []
    again = np.concatenate([configured(name)[8:], start(), rest(frame.length + 20)])
    pause = 12
    for cycle in range(frame.length + 5):
        hit = rest(cycle + 1 + pause)
        hit[cycle] |= RESET
        wave.append(np.concatenate([frame.before, hit, again]))
    for cycle, trace in enumerate(run(wave)):
        after_reset = frame.before.size + cycle + 1
        where = f"{name}: reset {cycle} cycles into the frame"
        quiet_part = trace.out[after_reset : after_reset + pause]
        assert not (quiet_part[:, 1] & (VAL | SYNC | BUSY | HOLD | MISO)).any() and not quiet_part[:, 2].any(), where
        cut = trace.taken < after_reset
        before, after = trace.out[trace.taken[cut], 0].tobytes(), trace.out[trace.taken[~cut], 0].tobytes()
        assert golden(name).stream.startswith(before) and after == golden(name).stream, where
        last = decode_stream(trace.stream)[-1]
        assert last.complete and np.array_equal(last.samples, golden(name).sent), f"{where}: as the host decodes it"


def test_reset_in_a_frame_resets_the_registers():
    frame, read = quiet("raw"), transfer(READ_ALL)
    wave = []
    for cycle in range(0, frame.length, 11):
        hit = rest(cycle + 10)
        hit[cycle] |= RESET
        wave.append(np.concatenate([frame.before, hit, read, status_wave()]))
    for trace in run(wave):
        at = trace.wave.size - status_wave().size
        assert trace.reply(at - read.size, len(READ_ALL))[1:] == DEFAULTS
        assert not any(trace.status(at).values())


def test_reset_in_the_middle_of_a_transfer():
    """The rest of the transfer is not read as commands: nothing starts and nothing is written."""
    bytes_of_starts = b"\x00" + command("start") * 4 + bytes((0x80 | CHIP["mode"].byte, 0xFF, 0xFF))
    read, wave = transfer(READ_ALL), []
    for first in (0x00, 0x80 | CHIP["t_int"].byte):
        hit = transfer(bytes((first,)) + bytes_of_starts)
        for cycle in range(0, hit.size - 8, 3):  # half an SPI clock is 4 cycles: every place in one is met
            some = hit.copy()
            some[cycle] |= RESET
            wave.append(np.concatenate([configured("raw"), some, rest(8), read]))
    for number, trace in enumerate(run(wave)):
        assert not trace.flag(BUSY).any(), f"case {number}: the rest of a transfer starts a frame"
        assert trace.reply(trace.wave.size - read.size, len(READ_ALL))[1:] == DEFAULTS, f"case {number}"
