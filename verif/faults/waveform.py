"""Waveforms at the chip's pins, a byte a cycle, and the trace that the chip answers with."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from models.digital.host import decode_status, status_transfers

SCLK, CSN, MOSI, RDY, RESET, PULSE_LOW, PULSE_HIGH = (1 << bit for bit in range(7))
REST = np.uint8(CSN | RDY)  # no transfer, the link takes every byte
HALF = 4  # cycles of half an SPI clock, the shortest allowed
RESET_CYCLES = 4
VAL, SYNC, BUSY, MISO, HOLD = (1 << bit for bit in range(5))
PIXEL_RESET, SHUTTER, REF_CTL, INTEGRATE, CM_RESET, READ, SAMPLE, TAP = (1 << bit for bit in range(8))


def rest(cycles):
    return np.full(cycles, REST)


def reset(cycles=RESET_CYCLES):
    """Reset, then a rest in which the SPI pins' synchronisers fill."""
    return np.concatenate([np.full(cycles, REST | RESET), rest(HALF)])


def transfer(data, bits=None):
    """An SPI transfer, with csn high for a while behind it. bits: cut after so many, in the middle of a byte."""
    sent = np.unpackbits(np.frombuffer(bytes(data), np.uint8))[:bits]
    high = np.repeat(sent * MOSI, 2 * HALF).astype(np.uint8)
    clock = np.tile(np.repeat(np.array([0, SCLK], np.uint8), HALF), sent.size)
    lead = np.full(HALF, RDY, np.uint8)
    return np.concatenate([lead, (high | clock | RDY).astype(np.uint8), lead, rest(2 * HALF)])


def transfers(items):
    return np.concatenate([transfer(item) for item in items])


@dataclass(frozen=True, eq=False)
class Trace:
    """wave: uint8 (cycles,), what went in. out: uint8 (cycles, 3): link_data, flags, phases."""

    wave: np.ndarray
    out: np.ndarray

    def flag(self, bit):
        return self.out[:, 1] & bit != 0

    @cached_property
    def taken(self):
        """Cycles in which the link takes a byte."""
        return np.flatnonzero(self.flag(VAL) & (self.wave & RDY != 0))

    @property
    def stream(self):
        return self.out[self.taken, 0].tobytes()

    def reply(self, start, size):
        """What came back in the transfer of ``size`` bytes that begins at cycle ``start``: bytes."""
        at = start + 2 * HALF - 1 + 2 * HALF * np.arange(8 * size)  # ahead of each rising edge of sclk
        return np.packbits(self.flag(MISO)[at]).tobytes()

    def status(self, start):
        """What `status_wave`, begun at cycle ``start``, brought: dict, see `decode_status`."""
        replies = []
        for item in status_transfers():
            replies.append(self.reply(start, len(item)))
            start += transfer(item).size
        return decode_status(replies)


def status_wave():
    """Transfers that read the status and the counters."""
    return transfers(status_transfers())
