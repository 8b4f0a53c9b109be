"""Metal fill: squares of no net where a layer has room, so that every layer is polished alike."""

import numpy as np
import numpy.typing as npt

from talbot.base.gds import db
from talbot.platforms.layers import Layer
from talbot.platforms.layout import Fill
from talbot.signoff.geometry.boxes import Box, Boxes, boxes

GRID = 200  # nm, of what is free
Pixels = npt.NDArray[np.int64]  # (n, 2)


def fill(layout: "db.Layout", top: "db.Cell", metal: Layer, rules: Fill) -> int:
    """Draw the squares of one layer into the cell ``top``, the largest first; how many."""
    layer, die = layout.layer(*metal.gds), top.bbox()
    drawn = db.Region(top.begin_shapes_rec(layer)).merged()
    wanted = rules.density * die.area() - drawn.area()
    space, clearance = (round(value / layout.dbu) for value in (rules.space_um, rules.clearance_um))
    room, squares = Room((die.left, die.bottom, die.right, die.top)), 0
    room.take(boxes(drawn), clearance)
    for side in (round(side / layout.dbu) for side in rules.sides_um):
        places = room.squares(side, side + space, space)
        count = min(len(places), max(0, -(-round(wanted) // side**2)))
        chosen = places[np.arange(count) * len(places) // max(1, count)]  # evenly over the layer
        for box in chosen.tolist():
            top.shapes(layer).insert(db.Box(*box))
        room.take(chosen, space)
        wanted -= count * side**2
        squares += count
    return squares


class Room:
    """The free area of ``box``, as pixels of GRID: a pixel is taken as soon as anything reaches into it."""

    def __init__(self, box: Box) -> None:
        self.box, self.corner = box, np.array(box[:2])
        self.taken = np.zeros([-(-(end - begin) // GRID) for begin, end in ((box[0], box[2]), (box[1], box[3]))], bool)

    def _pixels(self, places: Boxes) -> tuple[Pixels, Pixels]:
        """First pixels of the boxes ``places``, and those after the last."""
        return (places[:, :2] - self.corner) // GRID, -((self.corner - places[:, 2:]) // GRID)

    def take(self, places: Boxes, around: int) -> None:
        """Take the boxes ``places`` and what is nearer to them than ``around``."""
        pixels = self._pixels(places + np.array((-around, -around, around, around)))
        first, last = (np.clip(at, 0, self.taken.shape) for at in pixels)
        change = np.zeros(np.array(self.taken.shape) + 1, np.int32)
        for (x, y), sign in (((first, first), 1), ((last, first), -1), ((first, last), -1), ((last, last), 1)):
            np.add.at(change, (x[:, 0], y[:, 1]), sign)
        self.taken |= change.cumsum(0, np.int32).cumsum(1, np.int32)[:-1, :-1] > 0

    def squares(self, side: int, pitch: int, margin: int) -> Boxes:
        """Boxes of the free squares on a grid of ``pitch``, ``margin`` from the edge, in rows from below."""
        sums = np.pad(self.taken.cumsum(0, np.int32).cumsum(1, np.int32), ((1, 0), (1, 0)))
        begin, sides, first = self.corner, np.array(self.box[2:]) - self.corner, -(-margin // pitch) * pitch
        x, y = (np.arange(first, sides[k] - side - margin + 1, pitch) + begin[k] for k in (0, 1))
        x, y = (at.ravel() for at in np.meshgrid(x, y))
        places = np.stack((x, y, x + side, y + side), 1)
        (left, bottom), (right, top) = (at.T for at in self._pixels(places))
        return places[sums[right, top] - sums[left, top] - sums[right, bottom] + sums[left, bottom] == 0]


def peak_density(layout: "db.Layout", top: "db.Cell", metal: Layer, rules: Fill) -> float:
    """Covered share of a layer in the window of the cell where it is largest; windows overlap by half."""
    box, size = top.bbox(), round(rules.window_um / layout.dbu)
    drawn, found = db.Region(top.begin_shapes_rec(layout.layer(*metal.gds))).merged(), []
    for left in range(box.left, max(box.left + 1, box.right - size // 2), size // 2):
        for bottom in range(box.bottom, max(box.bottom + 1, box.top - size // 2), size // 2):
            window = db.Box(left, bottom, left + size, bottom + size) & box
            found.append((drawn & db.Region(window)).area() / window.area())
    return round(max(found), 4)
