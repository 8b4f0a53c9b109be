"""Wires of one track that Coriolis draws with no length, its caps having taken it all: joined from contact to contact."""

from coriolis.helpers import u
from coriolis.Hurricane import Box, Contact, Horizontal, Pad, UpdateSession, Vertical

REACH_UM = 0.6  # from such a wire to a contact at its end: more than half a track


def draw_short(cell):
    """Draw them as pads of their nets, where there is a contact at either end; returns how many."""
    found = []
    for net in cell.getNets():
        if not net.isSupply():
            parts = list(net.getComponents())
            contacts = [part for part in parts if isinstance(part, Contact) and part.getLayer() is not None]
            found += [
                (net, wire, box)
                for wire in parts
                if isinstance(wire, (Horizontal, Vertical))
                for box in [_joined(wire, contacts)]
                if box
            ]
    UpdateSession.open()
    for net, wire, box in found:
        Pad.create(net, wire.getLayer(), Box(*box))
    UpdateSession.close()
    return len(found)


def _joined(wire, contacts):
    """Corners of what a wire without a length lacks, or None."""
    box, flat, layer = wire.getBoundingBox(), isinstance(wire, Horizontal), wire.getLayer()
    if layer is None or (box.getWidth() if flat else box.getHeight()) > 0 or layer.getName().endswith(".block"):
        return None
    x, y, half = box.getXCenter(), box.getYCenter(), wire.getWidth() // 2
    own = [(part.getX() - x, part.getY() - y) for part in contacts if layer.getName() in part.getLayer().getName()]
    along = [dx if flat else dy for dx, dy in own if (dy if flat else dx) == 0 and abs(dx + dy) <= u(REACH_UM)]
    low, high = min(along, default=0), max(along, default=0)
    if low >= 0 or high <= 0:
        return None
    return (x + low, y - half, x + high, y + half) if flat else (x - half, y + low, x + half, y + high)
