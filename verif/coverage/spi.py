"""SPI transfers found in recorded pins."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Transfer:
    """at: cycle in which it ends. data: whole bytes. bits: received beyond them. half: the shortest half of a clock
    period, cycles. cut: by a reset."""

    at: int
    data: bytes
    bits: int
    half: int
    cut: bool

    @property
    def writes(self):
        return bool(self.data) and self.data[0] >= 0x80

    def bytes_at(self):
        """(address, byte) of each byte behind the command."""
        return [(min((self.data[0] & 0x7F) + i, 127), byte) for i, byte in enumerate(self.data[1:])]


def transfers(p):
    """All transfers of the pins of ``p`` (Recorded), in their order: list of Transfer."""
    selected = (p.csn == 0) & (p.reset == 0) & ~p.fresh
    before = np.concatenate(([False], selected[:-1]))
    behind = np.concatenate((selected[1:], [False]))
    rises = (p.sclk == 1) & (np.concatenate(([0], p.sclk[:-1])) == 0) & selected
    edges = np.flatnonzero(p.sclk != np.concatenate((p.sclk[1:], [0])))
    out = []
    for first, last in zip(np.flatnonzero(selected & ~before), np.flatnonzero(selected & ~behind), strict=True):
        at = np.flatnonzero(rises[first : last + 1]) + first
        bits = p.mosi[at]
        whole = len(bits) // 8
        halves = np.diff(edges[np.searchsorted(edges, first) : np.searchsorted(edges, last)])
        end = min(last + 1, len(selected) - 1)
        out.append(
            Transfer(
                end,
                np.packbits(bits[: 8 * whole].astype(np.uint8)).tobytes(),
                len(bits) % 8,
                int(halves.min()) if len(halves) else 0,
                bool(p.reset[end]),
            )
        )
    return out


def where(p, chosen):
    """True in the cycles in which the ``chosen`` transfers end."""
    out = np.zeros(len(p.fresh), bool)
    out[[transfer.at for transfer in chosen]] = True
    return out
