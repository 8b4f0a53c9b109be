"""Waveforms at the chip's input pins, one byte per cycle, and the traces of its outputs."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from talbot.models.digital.host import decode_status, status_transfers

SCLK, CSN, MOSI, RDY, RESET, PULSE_LOW, PULSE_HIGH = (1 << bit for bit in range(7))
REST = np.uint8(CSN | RDY)  # no transfer, the link takes every byte
HALF = 4  # cycles of half an SPI clock, the shortest allowed
RESET_CYCLES = 4
VAL, SYNC, BUSY, MISO, HOLD = (1 << bit for bit in range(5))
PIXEL_RESET, SHUTTER, REF_CTL, INTEGRATE, CM_RESET, READ, SAMPLE, TAP = (1 << bit for bit in range(8))


Wave = npt.NDArray[np.uint8]  # the input pins, one byte per cycle


def rest(cycles: int) -> Wave:
    """Return a wave in which nothing happens and the link takes every byte."""
    return np.full(cycles, REST)


def reset(cycles: int = RESET_CYCLES) -> Wave:
    """Return a reset and a rest in which the synchronisers of the SPI pins fill."""
    return np.concatenate([np.full(cycles, REST | RESET), rest(HALF)])


def transfer(data: Iterable[int], bits: int | None = None) -> Wave:
    """Return an SPI transfer of ``data``, then csn high. bits: cut after this number, also within a byte."""
    sent = np.unpackbits(np.frombuffer(bytes(data), np.uint8))[:bits]
    high = np.repeat(sent * MOSI, 2 * HALF).astype(np.uint8)
    clock = np.tile(np.repeat(np.array([0, SCLK], np.uint8), HALF), sent.size)
    lead = np.full(HALF, RDY, np.uint8)
    return np.concatenate([lead, (high | clock | RDY).astype(np.uint8), lead, rest(2 * HALF)])


def transfers(items: Iterable[Iterable[int]]) -> Wave:
    """Return SPI transfers one after the other."""
    return np.concatenate([transfer(item) for item in items])


@dataclass(frozen=True, eq=False)
class Trace:
    """The chip under a waveform. out: (cycles, 3), the outputs link_data, flags and phases."""

    wave: Wave
    out: npt.NDArray[np.uint8]

    def flag(self, bit: int) -> npt.NDArray[np.bool_]:
        """Return one of the flags by cycle."""
        return self.out[:, 1] & bit != 0

    @cached_property
    def taken(self) -> npt.NDArray[np.int64]:
        """Return the cycles in which the link takes a byte."""
        return np.flatnonzero(self.flag(VAL) & (self.wave & RDY != 0))

    @property
    def stream(self) -> bytes:
        """Return the bytes that the link takes."""
        return self.out[self.taken, 0].tobytes()

    def reply(self, start: int, size: int) -> bytes:
        """Return the bytes on miso in the transfer of ``size`` bytes that begins at cycle ``start``."""
        at = start + 2 * HALF - 1 + 2 * HALF * np.arange(8 * size)  # before each rising edge of sclk
        return np.packbits(self.flag(MISO)[at]).tobytes()

    def status(self, start: int) -> dict[str, int]:
        """Return the status that `status_wave`, begun at cycle ``start``, reads (see `decode_status`)."""
        replies = []
        for item in status_transfers():
            replies.append(self.reply(start, len(item)))
            start += transfer(item).size
        return decode_status(replies)


def status_wave() -> Wave:
    """Return the transfers that read the status and the counters."""
    return transfers(status_transfers())
