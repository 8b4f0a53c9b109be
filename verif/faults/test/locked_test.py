"""Configuration written, and a second start, at any time around a frame: refused and reported, or done."""

import numpy as np
import pytest

from talbot.models.digital.host import frame_writes, read_transfer
from talbot.models.parameters.registers import register_map
from talbot.verif.faults.chip import FRAMES, frame_of, golden, quiet, run, start
from talbot.verif.faults.waveform import BUSY, rest, status_wave, transfer

CHIP = register_map()
WRITABLE = CHIP.writable()
TRANSFER = start().size  # cycles of a transfer of two bytes


def changed_one_way(values):
    """True when a list of bools is True first, then False, each at least once."""
    falls = sum(a and not b for a, b in zip(values, values[1:], strict=False))
    return values[0] and not values[-1] and falls == 1 and sorted(values, reverse=True) == values


def write_in(name, cases):
    """Write to an address at a cycle of the frame, (address, cycle) pairs; returns for each whether it was refused.

    Asserts that the frame is the golden one and that the register has the new value exactly where it was not refused.
    """
    frame, held = quiet(name), dict(frame_writes(frame_of(name)))
    wave = []
    for address, cycle in cases:
        written = transfer((0x80 | address, held[address] ^ WRITABLE[address]))
        wave.append(
            np.concatenate(
                [
                    frame.before,
                    rest(cycle),
                    written,
                    rest(frame.length),
                    status_wave(),
                    transfer(read_transfer(address, 1)),
                ]
            )
        )
    refused, read = [], transfer(bytes(2)).size
    for (address, cycle), trace in zip(cases, run(wave), strict=True):
        where = f"{name}: address {address} written {cycle} cycles into the frame"
        status = trace.status(trace.wave.size - read - status_wave().size)
        now = trace.reply(trace.wave.size - read, 2)[1]
        assert trace.stream == golden(name).stream, where
        assert status["done"] and not status["busy"], where
        assert now == held[address] if status["refused"] else now == held[address] ^ WRITABLE[address], where
        refused.append(status["refused"])
    return refused


def test_every_register_in_the_middle_of_a_frame():
    assert all(write_in("phase", [(address, 40) for address in WRITABLE]))


@pytest.mark.parametrize("name", FRAMES)
def test_a_register_at_any_cycle(name):
    """Refused as long as the frame runs, accepted from its end on."""
    address = CHIP["t_int"].byte
    assert changed_one_way(write_in(name, [(address, cycle) for cycle in range(quiet(name).length + 20)]))


@pytest.mark.parametrize("name", FRAMES)
def test_a_second_start_at_any_cycle(name):
    """Refused while the frame runs: the frame is as it was. Behind it a second frame, and `done` is of that one."""
    frame, refused = quiet(name), []
    last = frame.length + 20
    wave = [
        np.concatenate([frame.before, rest(cycle), start(), status_wave(), rest(last - cycle + frame.length)])
        for cycle in range(last)
    ]
    for cycle, trace in enumerate(run(wave)):
        where = f"{name}: started again {cycle} cycles into the frame"
        status = trace.status(frame.before.size + cycle + TRANSFER)
        refused.append(status["refused"])
        assert trace.stream == golden(name).stream * (1 if status["refused"] else 2), where
        if not status["refused"]:
            assert status["busy"] and not status["done"], f"{where}: `done` is of the frame before"
        assert not trace.flag(BUSY)[-1]
    assert changed_one_way(refused)
