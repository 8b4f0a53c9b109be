"""Power straps on the top layer, joined to the cells' rails by via stacks."""

from collections.abc import Iterable, Sequence
from typing import Any

from coriolis.helpers import u
from coriolis.Hurricane import Box, DataBase, DbU, Horizontal, Pad, UpdateSession, Vertical

CLEARANCE_UM = 0.8
PIN_CLEARANCE_UM = 1.6  # of a strap's axis from a pin beneath it
SUPPLIES = "vss", "vdd"
Strap = tuple[str, float, list[tuple[float, float]]]  # supply, x (um), gaps
Box_um = tuple[float, float, float, float]


class Straps:
    """Straps of ``cell`` in pairs (ground, supply) every ``strap_pitch_um``; the rails of even rows are ground.

    The straps of a macro continue through the whole core, and between the sides of its outer box there are no others.
    """

    def __init__(self, cell: Any, request: dict[str, Any]) -> None:
        self.cell, self.request = cell, request
        self.x: list[Strap] = []
        self.layer = DataBase.getDB().getTechnology().getLayer
        self.names = [metal["name"] for metal in request["metals"]]
        self.outer = sorted(macro["outer"] for macro in request["macros"])
        sizes = [(m["x_um"], m["y_um"], m["width_um"], m["height_um"]) for m in request["macros"]]
        self.inner = [(x, y, x + width, y + height) for x, y, width, height in sizes]
        self.through = [(net, macro["x_um"] + x) for macro in request["macros"] for net, x in macro["straps"]]

    def even(self) -> list[tuple[str, float, float]]:
        """(supply, x, pitch) of every strap (um) in an even pitch, between the macros."""
        edges = [0.0, *(x for box in self.outer for x in (box[0], box[2])), self.request["width_um"]]
        found = []
        for left, right in zip(edges[::2], edges[1::2], strict=True):
            count = 2 * max(1, round((right - left) / self.request["strap_pitch_um"]))
            for k in range(count):
                found.append((SUPPLIES[k % 2], left + (right - left) * (k + 0.5) / count, (right - left) / count))
        return found

    def positions(self, pins: Sequence[float]) -> list[Strap]:
        """Place every strap as near to `even` as other nets and the pins at x in ``pins`` allow.

        gaps: (bottom, top) where one of a macro, which stays at its x, has room for the clock trunk.
        """
        half = self.request["strap_um"] / 2
        signals = [_enlarged(box) for box in self._signals(self.names[-1])]
        taken = [(left - half, right + half) for left, _, right, _ in signals]
        taken += [(x - PIN_CLEARANCE_UM, x + PIN_CLEARANCE_UM) for x in pins]
        for net, ideal, pitch in self.even():
            moves = (step * 0.5 * sign for step in range(int(pitch)) for sign in (1, -1))
            x = next((ideal + move for move in moves if not any(a < ideal + move < b for a, b in taken)), None)
            if x is None:
                raise SystemExit(f"coriolis: no place for a strap near x = {ideal:.1f} um")
            self.x.append((net, round(self._on_grid(x), 3), []))
        for net, x in self.through:
            gaps = [(low, high) for left, low, right, high in signals if left < x + half and x - half < right]
            self.x.append((net, x, _merged(gaps)))
        self.x.sort(key=lambda strap: strap[1])
        return self.x

    def create(self) -> None:
        """Draw the straps and via stacks, except stacks that would short to a net or are in macros.

        Where the outermost rails are half outside, straps end with the stacks on these.
        """
        UpdateSession.open()
        height, width = self.request["height_um"], self.request["strap_um"]
        rows = round(height / self.request["row_um"])
        signals = {name: self._signals(name) for name in self.names[self.request["rail"] + 1 :]}
        beyond = self.request["rail_overlap_um"] / 2 if self.request["rails_over_edge"] else 0.0
        for supply, x, gaps in self.x:
            net, odd = self.cell.getNet(supply), SUPPLIES.index(supply)
            ends = [-beyond, *(y for gap in gaps for y in gap), height + beyond]
            for low, high in zip(ends[::2], ends[1::2], strict=True):
                if high > low:
                    low, high = u(self._on_grid(low)), u(self._on_grid(high))
                    Vertical.create(net, self.layer(self.names[-1]), u(x), u(width), low, high)
            for row in range(odd, rows + 1, 2):
                y, overlap = row * self.request["row_um"], self.request["rail_overlap_um"]
                if any(left < x < right and low - 1e-6 <= y <= high + 1e-6 for left, low, right, high in self.inner):
                    continue
                if row in (0, rows) and not self.request["rails_over_edge"]:  # half a rail at the edge
                    overlap *= 2 / 3
                    y += overlap / 2 if row == 0 else -overlap / 2
                box = (x - width / 2, y - overlap / 2, x + width / 2, y + overlap / 2)
                if not any(_meet(box, other) for boxes in signals.values() for other in boxes):
                    self._stack(net, x, y, width, overlap)
        UpdateSession.close()

    def _stack(self, net: Any, x: float, y: float, width: float, height: float) -> None:
        rail = self.request["rail"]
        for level, name in enumerate(self.names[rail + 1 : -1], rail):
            if level % 2 == 0:
                Horizontal.create(net, self.layer(name), u(y), u(height), u(x - width / 2), u(x + width / 2))
            else:
                Vertical.create(net, self.layer(name), u(x), u(width), u(y - height / 2), u(y + height / 2))
        for via in self.request["vias"][rail:]:
            size, pitch = via["size_um"], via["size_um"] + via["space_um"]
            room = via["space_um"] - 2 * via["enclosure_um"]
            across, along = (int((side + room) / pitch + 1e-9) for side in (width, height))
            for i in range(across):
                for j in range(along):
                    left = u(self._on_grid(x + (i - (across - 1) / 2) * pitch - size / 2))
                    low = u(self._on_grid(y + (j - (along - 1) / 2) * pitch - size / 2))
                    Pad.create(net, self.layer(via["name"]), Box(left, low, left + u(size), low + u(size)))

    def _on_grid(self, value: float) -> float:
        return round(value / self.request["grid_um"]) * self.request["grid_um"]

    def _signals(self, name: str) -> list[Box_um]:
        """Boxes (um) of the signals on the layer ``name`` so far: the trunk of the clock tree."""
        wanted, boxes = self.layer(name).getMask(), []
        for net in self.cell.getNets():
            if net.isSupply():
                continue
            for component in net.getComponents():
                layer = component.getLayer()
                if layer is not None and layer.getMask().intersect(wanted):
                    box = component.getBoundingBox()
                    ends = box.getXMin(), box.getYMin(), box.getXMax(), box.getYMax()
                    boxes.append(tuple(DbU.toPhysical(end, DbU.UnitPowerMicro) for end in ends))
        return boxes


def _enlarged(box: Box_um) -> Box_um:
    return box[0] - CLEARANCE_UM, box[1] - CLEARANCE_UM, box[2] + CLEARANCE_UM, box[3] + CLEARANCE_UM


def _meet(a: Box_um, b: Box_um) -> bool:
    left, bottom, right, top = _enlarged(a)
    return left < b[2] and b[0] < right and bottom < b[3] and b[1] < top


def _merged(intervals: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Sorted list of (low, high), none touching another."""
    made = []
    for low, high in sorted(intervals):
        if made and low <= made[-1][1]:
            made[-1] = made[-1][0], max(high, made[-1][1])
        else:
            made.append((low, high))
    return made
