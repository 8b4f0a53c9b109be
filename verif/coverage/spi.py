"""SPI transfers found in recorded pins."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from talbot.verif.coverage.ports import Mask, Recorded


@dataclass(frozen=True)
class Transfer:
    """An SPI transfer.

    at: cycle in which it ends. data: whole bytes. bits: received after them. half: the shortest half of a clock period,
    in cycles. cut: by a reset.
    """

    at: int
    data: bytes
    bits: int
    half: int
    cut: bool

    @property
    def writes(self) -> bool:
        """True for a command that writes."""
        return bool(self.data) and self.data[0] >= 0x80

    def bytes_at(self) -> list[tuple[int, int]]:
        """Return (address, byte) of each byte after the command."""
        return [(min((self.data[0] & 0x7F) + i, 127), byte) for i, byte in enumerate(self.data[1:])]


def transfers(p: Recorded) -> list[Transfer]:
    """Return all transfers of the pins csn, sclk and mosi of ``p`` in their order."""
    selected = (p.csn == 0) & (p.reset == 0) & ~p.fresh
    before = np.concatenate(([False], selected[:-1]))
    after = np.concatenate((selected[1:], [False]))
    rises = (p.sclk == 1) & (np.concatenate(([0], p.sclk[:-1])) == 0) & selected
    edges = np.flatnonzero(p.sclk != np.concatenate((p.sclk[1:], [0])))
    out = []
    for first, last in zip(np.flatnonzero(selected & ~before), np.flatnonzero(selected & ~after), strict=True):
        at = np.flatnonzero(rises[first : last + 1]) + first
        bits = p.mosi[at]
        whole = len(bits) // 8
        halves = np.diff(edges[np.searchsorted(edges, first) : np.searchsorted(edges, last)])
        end = min(int(last) + 1, len(selected) - 1)
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


def where(p: Recorded, chosen: Iterable[Transfer]) -> Mask:
    """Return True in the cycles in which the ``chosen`` transfers end."""
    out = np.zeros(len(p.fresh), bool)
    out[[transfer.at for transfer in chosen]] = True
    return out
