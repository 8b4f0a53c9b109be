"""The link's `rdy` sticks: no byte is lost, the chip waits, SPI answers, and reset recovers."""

import numpy as np
import pytest

from talbot.models.digital.host import command, read_transfer
from talbot.models.parameters.registers import register_map
from talbot.verif.faults.chip import FRAMES, configured, golden, quiet, run, start
from talbot.verif.faults.waveform import BUSY, RDY, VAL, reset, rest, status_wave, transfer

CHIP = register_map()
STUCK = 150


def stuck(wave):
    return wave & ~np.uint8(RDY)


def offers_stand(trace):
    """A byte that is offered and not taken is offered unchanged in the next cycle."""
    waits = np.flatnonzero(trace.flag(VAL)[:-1] & (trace.wave[:-1] & RDY == 0))
    return trace.flag(VAL)[waits + 1].all() and (trace.out[waits, 0] == trace.out[waits + 1, 0]).all()


@pytest.mark.parametrize("name", FRAMES)
def test_rdy_sticks_for_a_while_at_any_cycle(name):
    """The same bytes later; `busy` stays high, and an offered byte does not change."""
    frame = quiet(name)
    traces = run(
        [
            np.concatenate([frame.before, rest(c), stuck(rest(STUCK)), rest(frame.length + STUCK)])
            for c in range(frame.length)
        ]
    )
    for cycle, trace in enumerate(traces):
        first = frame.before.size + cycle
        assert trace.stream == golden(name).stream, f"rdy stuck from cycle {cycle} of the frame"
        assert not ((trace.taken >= first) & (trace.taken < first + STUCK)).any()
        if cycle and first <= frame.trace.taken[-1]:
            assert trace.flag(BUSY)[first : first + STUCK].all(), f"not busy while rdy is stuck from cycle {cycle}"
        assert offers_stand(trace), f"rdy stuck from cycle {cycle}: an offered byte changes"


@pytest.mark.parametrize("name", FRAMES)
def test_rdy_sticks_for_ever(name):
    """While bytes are left the status says so (busy, not done), registers can be read, a start is refused; only reset
    ends it."""
    frame, first = quiet(name), CHIP["t_int"].byte
    asks = [status_wave(), start(), transfer(read_transfer(first, 2)), status_wave()]
    again = np.concatenate([configured(name), start(), rest(frame.length + 20)])
    cycles = range(1, int(frame.trace.taken[-1]) - frame.before.size + 1, 7)
    traces = run(
        [
            np.concatenate([frame.before, rest(c), stuck(np.concatenate([rest(600), *asks])), reset(1), again])
            for c in cycles
        ]
    )
    for cycle, trace in zip(cycles, traces, strict=True):
        at = frame.before.size + cycle + 600
        status = trace.status(at)
        assert status["busy"] and not status["done"] and not status["refused"], cycle
        at += asks[0].size + asks[1].size
        assert trace.reply(at, 3)[1:] == b"\x03\x00"
        status = trace.status(at + asks[2].size)
        assert status["busy"] and status["refused"] and not status["done"], cycle
        assert trace.stream.endswith(golden(name).stream), f"after rdy stuck from cycle {cycle} and a reset"


def test_rdy_sticks_in_loop_back():
    """One byte waits until it is taken; later ones are refused meanwhile."""
    loop, enable = CHIP["loop_back"].byte, CHIP["loop_enable"]
    wave = [
        reset(),
        transfer((0x80 | enable.byte, 1 << enable.shift)),
        stuck(transfer((0x80 | loop, 11, 12, 13))),
        stuck(rest(50)),
        status_wave(),
        transfer(command("refused")),
        transfer((0x80 | loop, 14)),
        status_wave(),
    ]
    (trace,) = run([np.concatenate(wave)])
    assert trace.stream == bytes((11, 14)) and offers_stand(trace)
    starts = np.cumsum([0] + [w.size for w in wave])
    assert trace.status(starts[4])["refused"] and not trace.status(starts[7])["refused"]
