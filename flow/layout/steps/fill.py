"""Metal fill: squares of no net where a layer has room, so that every layer is polished alike."""

import json
from dataclasses import dataclass

import numpy as np

from base.gds import write_gds
from base.steps import Step
from platforms.coriolis import coriolis_platform

from ..geometry import boxes as boxes_module
from ..geometry.boxes import boxes

GRID = 200  # nm, of what is free


@dataclass(frozen=True)
class FillParameters:
    """pdk: process."""

    pdk: str = "sky130"


class Fill(Step):
    """The largest squares first, until a layer has its density or no room. before, after: covered share by layer.

    density_violations: windows with more metal than the process allows. The fill's capacitance is not extracted: it
    stays away from wires by the process's clearance.
    """

    name = "fill"
    inputs = {"gds": "stream_out.gds"}
    outputs = {"gds": "layout.gds", "summary": "fill.json"}
    Parameters = FillParameters
    metrics = {"squares": "", "before": "", "after": "", "density_violations": ""}
    uses = (boxes_module,)
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db

        known = coriolis_platform(self.parameters.pdk)
        layout = db.Layout()
        layout.read(str(inputs["gds"]))
        top, squares = layout.top_cell(), 0
        before = {wire.name: densest(layout, top, wire, known.fill) for wire in known.metals}
        for wire in known.metals[1:]:
            squares += fill(layout, top, wire, known.fill)
        after = {wire.name: densest(layout, top, wire, known.fill) for wire in known.metals}
        write_gds(layout, outputs["gds"])
        dense = {name: density for name, density in after.items() if density > known.fill.density_most}
        told = {"before": before, "after": after, "too dense": dense}
        outputs["summary"].write_text(json.dumps(told, indent=1) + "\n")
        return {"squares": squares, "before": before, "after": after, "density_violations": len(dense)}


def fill(layout, top, wire, rules):
    """Draw the squares of one wire's layer into the cell ``top``; returns how many."""
    import klayout.db as db

    layer, die = layout.layer(*wire.gds), top.bbox()
    metal = db.Region(top.begin_shapes_rec(layer)).merged()
    wanted = rules.density * die.area() - metal.area()
    space, clearance = (round(value / layout.dbu) for value in (rules.space_um, rules.clearance_um))
    room, drawn = Room((die.left, die.bottom, die.right, die.top)), 0
    room.take(boxes(metal), clearance)
    for side in (round(side / layout.dbu) for side in rules.sides_um):
        places = room.squares(side, side + space, space)
        count = min(len(places), max(0, -(-round(wanted) // side**2)))
        chosen = places[np.arange(count) * len(places) // max(1, count)]  # evenly over the layer
        for box in chosen.tolist():
            top.shapes(layer).insert(db.Box(*box))
        room.take(chosen, space)
        wanted -= count * side**2
        drawn += count
    return drawn


class Room:
    """Where nothing is yet in ``box`` (left, bottom, right, top): as pixels of GRID, a pixel taken as soon as anything
    reaches into it."""

    def __init__(self, box):
        self.box, self.corner = box, np.array(box[:2])
        self.taken = np.zeros([-(-(end - begin) // GRID) for begin, end in ((box[0], box[2]), (box[1], box[3]))], bool)

    def _pixels(self, places):
        """First pixels of the boxes ``places`` (n, 4), and those behind the last: two arrays (n, 2)."""
        return (places[:, :2] - self.corner) // GRID, -((self.corner - places[:, 2:]) // GRID)

    def take(self, places, around):
        """Take the boxes ``places`` (n, 4) and what is nearer to them than ``around``."""
        first, last = (
            np.clip(at, 0, self.taken.shape)
            for at in self._pixels(places + np.array((-around, -around, around, around)))
        )
        change = np.zeros(np.array(self.taken.shape) + 1, np.int32)
        for (x, y), sign in (((first, first), 1), ((last, first), -1), ((first, last), -1), ((last, last), 1)):
            np.add.at(change, (x[:, 0], y[:, 1]), sign)
        self.taken |= change.cumsum(0, np.int32).cumsum(1, np.int32)[:-1, :-1] > 0

    def squares(self, side, pitch, margin):
        """Boxes (n, 4) of the free squares on a grid of ``pitch``, ``margin`` from the edge, in rows from below."""
        sums = np.pad(self.taken.cumsum(0, np.int32).cumsum(1, np.int32), ((1, 0), (1, 0)))
        x, y = (
            np.arange(-(-margin // pitch) * pitch, end - begin - side - margin + 1, pitch) + begin
            for begin, end in ((self.box[0], self.box[2]), (self.box[1], self.box[3]))
        )
        x, y = (at.ravel() for at in np.meshgrid(x, y))
        places = np.stack((x, y, x + side, y + side), 1)
        (left, bottom), (right, top) = (at.T for at in self._pixels(places))
        return places[sums[right, top] - sums[left, top] - sums[right, bottom] + sums[left, bottom] == 0]


def densest(layout, top, wire, rules):
    """Covered share of a wire's layer in the window of the cell where it is largest; windows overlap by half."""
    import klayout.db as db

    box, size = top.bbox(), round(rules.window_um / layout.dbu)
    metal, found = db.Region(top.begin_shapes_rec(layout.layer(*wire.gds))).merged(), []
    for left in range(box.left, max(box.left + 1, box.right - size // 2), size // 2):
        for bottom in range(box.bottom, max(box.bottom + 1, box.top - size // 2), size // 2):
            window = db.Box(left, bottom, left + size, bottom + size) & box
            found.append((metal & db.Region(window)).area() / window.area())
    return round(max(found), 4)
