"""A part of the layout as a grid: where the middle of a wire, and a cut, may lie."""

import numpy as np
from numba import njit


class Window:
    """layout, top: KLayout's. wiring: Wiring. box: (left, bottom, right, top) in nm. own: dict level -> boxes that are
    no obstacles. wires[level], cuts[level]: arrays of bool, [column, row]; a cut's level is that of the layer below."""

    def __init__(self, layout, top, wiring, box, own):
        self.wiring, (self.dx, self.dy) = wiring, wiring.step
        self.left, self.bottom = box[0] // self.dx * self.dx, box[1] // self.dy * self.dy
        self.columns, self.rows = (box[2] - self.left) // self.dx + 1, (box[3] - self.bottom) // self.dy + 1
        reach = (self.left - 1000, self.bottom - 1000, box[2] + 1000, box[3] + 1000)
        self.obstacles = {level: _boxes(layout, top, layer, reach, own.get(level, ()))
                          for level, layer in enumerate(wiring.layers) if level}
        self.wires = {level: self._free(level, self._half(level)) for level in self.obstacles}
        self.cuts = {level: self._free(level, cut.below) & self._free(level + 1, cut.above)
                     for level, cut in enumerate(wiring.cuts) if level}

    def at(self, i, j):
        """(x, y) in nm of a place."""
        return self.left + i * self.dx, self.bottom + j * self.dy

    def near(self, x, y):
        """Places (i, j) around a point: at most four."""
        i, j = (x - self.left) // self.dx, (y - self.bottom) // self.dy
        right, up = bool((x - self.left) % self.dx), bool((y - self.bottom) % self.dy)
        return [(i + a, j + b) for a in range(1 + right) for b in range(1 + up)
                if 0 < i + a < self.columns - 1 and 0 < j + b < self.rows - 1]

    def clear(self, level, box):
        """Whether nothing of others is nearer to ``box`` (nm) than wires must be."""
        space, there = self.wiring.layers[level].space, self.obstacles[level]
        return not np.any((there[:, 0] < box[2] + space) & (there[:, 2] > box[0] - space)
                          & (there[:, 1] < box[3] + space) & (there[:, 3] > box[1] - space))

    def block(self, level, box):
        """From now on nothing comes near ``box`` (nm) of the same net."""
        self.obstacles[level] = np.vstack([self.obstacles[level], box])
        self._keep_off(self.wires[level], level, self._half(level), box)
        for below, pad in ((level, "below"), (level - 1, "above")):
            if below in self.cuts:
                self._keep_off(self.cuts[below], level, getattr(self.wiring.cuts[below], pad), box)

    def _half(self, level):
        return (self.wiring.layers[level].width // 2,) * 2

    def _free(self, level, half):
        """Where a box of half the size ``half`` keeps its distance; never at the window's edge."""
        free = np.zeros((self.columns, self.rows), bool)
        free[1:-1, 1:-1] = True
        self._keep_off(free, level, half, self.obstacles[level])
        return free

    def _keep_off(self, free, level, half, boxes):
        reach = np.array(half) + self.wiring.layers[level].space
        boxes = np.reshape(boxes, (-1, 4)) - (self.left, self.bottom) * 2
        step = np.array((self.dx, self.dy))
        first, last = (boxes[:, :2] - reach) // step + 1, -((-boxes[:, 2:] - reach) // step)
        _clear(free, np.maximum(0, first), np.maximum(0, last))


@njit(cache=True)
def _clear(free, first, last):
    """Set ``free`` to False from the places ``first`` to before ``last``, arrays (n, 2)."""
    for k in range(len(first)):
        free[first[k, 0]:last[k, 0], first[k, 1]:last[k, 1]] = False


def _boxes(layout, top, layer, reach, own):
    """Boxes (n, 4) of what lies on ``layer`` in ``reach`` and does not meet a box of ``own``."""
    import klayout.db as db
    area = db.Region(top.begin_shapes_rec_touching(layout.layer(layer.layer, layer.datatype), db.Box(*reach)))
    found = []
    for polygon in area.each():
        parts = [polygon.bbox()] if polygon.is_box() else [part.bbox() for part in polygon.decompose_trapezoids()]
        found += [(p.left, p.bottom, p.right, p.top) for p in parts]
    found = np.array(found, int).reshape(-1, 4)
    for a in own:
        found = found[~np.all((found[:, :2] < a[2:]) & (found[:, 2:] > a[:2]), axis=1)]
    return found
