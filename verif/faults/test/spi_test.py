"""SPI transfers cut short, clocks without select, glitches: only complete bytes take effect."""

import numpy as np
import pytest

from talbot.models.digital.host import command, read_transfer
from talbot.models.parameters.registers import register_map
from talbot.verif.faults.chip import golden, quiet, resets, run
from talbot.verif.faults.waveform import BUSY, CSN, RDY, SCLK, reset, rest, status_wave, transfer

CHIP = register_map()
FIRST = CHIP["t_reset"].byte
HELD = resets()
BEFORE = np.concatenate([reset(), rest(4)])
BYTES = (0x5A, 0xC3, 0x7E)


def cut_write(bits):
    return transfer((0x80 | FIRST, *BYTES), bits)


def test_a_write_cut_at_any_bit():
    """The whole bytes are written, the cut one leaves its register as it was, and the next transfer is good."""
    whole, read = 8 * (1 + len(BYTES)), read_transfer(FIRST, len(BYTES))
    traces = run([np.concatenate([BEFORE, cut_write(bits), transfer(read)]) for bits in range(whole + 1)])
    for bits, trace in enumerate(traces):
        written = max(bits // 8 - 1, 0)
        wanted = bytes(BYTES[:written]) + bytes(HELD[FIRST + i] for i in range(written, len(BYTES)))
        assert trace.reply(trace.wave.size - transfer(read).size, len(read))[1:] == wanted, f"cut after {bits} bits"


def test_a_start_cut_at_any_bit():
    """Nothing starts until its last bit is in."""
    traces = run([np.concatenate([BEFORE, transfer(command("start"), bits), rest(20)]) for bits in range(17)])
    assert [bool(trace.flag(BUSY).any()) for trace in traces] == [False] * 16 + [True]


def test_a_read_cut_at_any_bit():
    """Nothing is written, and the next read is right."""
    read = read_transfer(FIRST, 4)
    wanted = bytes(HELD[FIRST + i] for i in range(4))
    for bits, trace in enumerate(
        run([np.concatenate([BEFORE, transfer(read, bits), transfer(read)]) for bits in range(8 * len(read))])
    ):
        assert trace.reply(trace.wave.size - transfer(read).size, len(read))[1:] == wanted, f"cut after {bits} bits"


@pytest.mark.parametrize("bits", range(0, 33, 3))
def test_cut_in_the_middle_of_a_frame(bits):
    """The frame is not affected; `refused` is set where a whole byte arrived."""
    frame = quiet("edge")
    cut = cut_write(bits)
    (trace,) = run([np.concatenate([frame.before, rest(5), cut, rest(frame.length), status_wave()])])
    assert frame.length > cut.size or bits > 28
    assert trace.stream == golden("edge").stream
    status = trace.status(trace.wave.size - status_wave().size)
    assert status["done"] and not status["busy"] and status["refused"] == (bits >= 16)


def test_a_clock_without_select_and_selects_without_a_clock():
    """At rest and in a frame: not a bit is taken, no output differs."""
    frame = quiet("raw")
    clock = rest(frame.length + 50)
    clock[np.arange(clock.size) % 8 >= 4] |= SCLK
    selects = rest(frame.length + 50)
    for length in range(1, 9):
        selects[20 * length : 20 * length + length] = RDY
    for wave in (clock, selects):
        (trace,) = run([np.concatenate([frame.before, wave])])
        assert trace.stream == golden("raw").stream
        assert np.array_equal(trace.out, frame.trace.out[: trace.wave.size])
        (rested,) = run([np.concatenate([BEFORE, wave, transfer(read_transfer(FIRST, 2)), status_wave()])])
        at = BEFORE.size + wave.size
        assert rested.reply(at, 3)[1:] == bytes((HELD[FIRST], HELD[FIRST + 1])) and not rested.flag(BUSY).any()
        assert not any(rested.status(at + transfer(bytes(3)).size).values())
    assert (clock & CSN).all()
