"""Segments of one track that Coriolis draws with no length, all of it in the caps: joined from contact to contact."""

from typing import Any

from coriolis.helpers import u
from coriolis.Hurricane import Box, Contact, Horizontal, Pad, UpdateSession, Vertical

REACH_UM = 0.6  # from such a segment to a contact at its end: more than half a track


def draw_short(cell: Any) -> int:
    """Draw them as pads of their nets, where there is a contact at either end; return how many."""
    found = []
    for net in cell.getNets():
        if not net.isSupply():
            parts = list(net.getComponents())
            contacts = [part for part in parts if isinstance(part, Contact) and part.getLayer() is not None]
            for segment in parts:
                if isinstance(segment, (Horizontal, Vertical)) and (box := _joined(segment, contacts)):
                    found.append((net, segment, box))
    UpdateSession.open()
    for net, segment, box in found:
        Pad.create(net, segment.getLayer(), Box(*box))
    UpdateSession.close()
    return len(found)


def _joined(segment: Any, contacts: list[Any]) -> tuple[int, int, int, int] | None:
    """Corners of what a segment without a length lacks, or None."""
    box, flat, layer = segment.getBoundingBox(), isinstance(segment, Horizontal), segment.getLayer()
    if layer is None or (box.getWidth() if flat else box.getHeight()) > 0 or layer.getName().endswith(".block"):
        return None
    x, y, half = box.getXCenter(), box.getYCenter(), segment.getWidth() // 2
    own = [(part.getX() - x, part.getY() - y) for part in contacts if layer.getName() in part.getLayer().getName()]
    along = [dx if flat else dy for dx, dy in own if (dy if flat else dx) == 0 and abs(dx + dy) <= u(REACH_UM)]
    low, high = min(along, default=0), max(along, default=0)
    if low >= 0 or high <= 0:
        return None
    return (x + low, y - half, x + high, y + half) if flat else (x - half, y + low, x + half, y + high)
