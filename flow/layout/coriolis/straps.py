"""Power straps on the highest wire, joined to the cells' rails by stacks of cuts."""

from coriolis.helpers import u
from coriolis.Hurricane import Box, DataBase, DbU, Horizontal, Pad, UpdateSession, Vertical

CLEARANCE_UM = 0.8
PIN_CLEARANCE_UM = 1.6  # of a strap's axis from a pin beneath it


class Straps:
    """Of ``cell``, in pairs (ground, supply) every ``strap_pitch_um``; the rails of even rows are ground."""

    def __init__(self, cell, request):
        self.cell, self.request, self.x = cell, request, []
        self.layer = DataBase.getDB().getTechnology().getLayer
        self.names = [wire["name"] for wire in request["wires"]]

    def even(self):
        """x of every strap (um) in an even pitch: list."""
        width = self.request["width_um"]
        count = 2 * max(1, round(width / self.request["strap_pitch_um"]))
        return [width * (k + 0.5) / count for k in range(count)]

    def positions(self, pins):
        """x of every strap (um), as near to `even` as what runs there and the pins at x in ``pins`` allow: list."""
        half = self.request["strap_um"] / 2
        taken = [(a - CLEARANCE_UM - half, b + CLEARANCE_UM + half) for a, _, b, _ in self._signals(self.names[-1])]
        taken += [(x - PIN_CLEARANCE_UM, x + PIN_CLEARANCE_UM) for x in pins]
        even = self.even()
        for ideal in even:
            moves = (step * 0.5 * sign for step in range(int(self.request["width_um"] / len(even))) for sign in (1, -1))
            x = next((ideal + move for move in moves if not any(a < ideal + move < b for a, b in taken)), None)
            if x is None:
                raise SystemExit(f"coriolis: no place for a strap near x = {ideal:.1f} um")
            self.x.append(round(self._on_grid(x), 3))
        return self.x

    def create(self):
        """Draw the straps and stacks; a stack that would meet a wire already there is left out."""
        UpdateSession.open()
        height, width = self.request["height_um"], self.request["strap_um"]
        rows = round(height / self.request["row_um"])
        there = {name: self._signals(name) for name in self.names[1:]}
        for k, x in enumerate(self.x):
            net = self.cell.getNet("vdd" if k % 2 else "vss")
            Vertical.create(net, self.layer(self.names[-1]), u(x), u(width), u(0.0), u(height))
            for row in range(k % 2, rows + 1, 2):
                y, overlap = row * self.request["row_um"], self.request["rail_overlap_um"]
                if row in (0, rows):            # half a rail at the edge
                    overlap *= 2 / 3
                    y += overlap / 2 if row == 0 else -overlap / 2
                box = (x - width / 2, y - overlap / 2, x + width / 2, y + overlap / 2)
                if not any(_meet(box, other) for boxes in there.values() for other in boxes):
                    self._stack(net, x, y, width, overlap)
        UpdateSession.close()

    def _stack(self, net, x, y, width, height):
        for level, name in enumerate(self.names[1:-1]):
            if level % 2 == 0:
                Horizontal.create(net, self.layer(name), u(y), u(height), u(x - width / 2), u(x + width / 2))
            else:
                Vertical.create(net, self.layer(name), u(x), u(width), u(y - height / 2), u(y + height / 2))
        for cut in self.request["cuts"]:
            size, pitch = cut["size_um"], cut["size_um"] + cut["space_um"]
            across, along = (int((side - 2 * cut["enclosure_um"] + cut["space_um"]) / pitch + 1e-9)
                             for side in (width, height))
            for i in range(across):
                for j in range(along):
                    left = u(self._on_grid(x + (i - (across - 1) / 2) * pitch - size / 2))
                    low = u(self._on_grid(y + (j - (along - 1) / 2) * pitch - size / 2))
                    Pad.create(net, self.layer(cut["name"]), Box(left, low, left + u(size), low + u(size)))

    def _on_grid(self, value):
        return round(value / self.request["grid_um"]) * self.request["grid_um"]

    def _signals(self, name):
        """Boxes (um) of what signals have in the wire ``name`` so far: the trunk of the clock tree."""
        wanted, boxes = self.layer(name).getMask(), []
        for net in self.cell.getNets():
            if net.isSupply():
                continue
            for component in net.getComponents():
                layer = component.getLayer()
                if layer is not None and layer.getMask().intersect(wanted):
                    box = component.getBoundingBox()
                    boxes.append(tuple(DbU.toPhysical(v, DbU.UnitPowerMicro) for v in
                                       (box.getXMin(), box.getYMin(), box.getXMax(), box.getYMax())))
        return boxes


def _meet(a, b):
    return (a[0] - CLEARANCE_UM < b[2] and b[0] < a[2] + CLEARANCE_UM
            and a[1] - CLEARANCE_UM < b[3] and b[1] < a[3] + CLEARANCE_UM)
