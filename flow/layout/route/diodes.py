"""Diodes against antennas, in empty places of rows: a diffusion beside a gate takes the charge that metal gathers."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from talbot.base.gds import db
from talbot.platforms.coriolis import CoriolisPlatform

from ..geometry.boxes import Box
from ..geometry.instances import insert, transformation
from ..geometry.rows import Place, Rows, free_rows
from ..netlist.netlist import DIODE, Netlist, diode
from ..netlist.placed import Masters, pin_boxes
from .board import Board, middle


class Diodes:
    """The diodes of a layout, and the room for more.

    placed: instances of the placement. library: KLayout layout of the cells. areas: um2 by cell. nets: of the diodes.
    fill: how many more of each fill cell there are than placed.
    """

    def __init__(
        self, placed: Sequence[Sequence[Any]], masters: Masters, library: "db.Layout", areas: Mapping[str, float],
        tech: CoriolisPlatform,
    ) -> None:  # fmt: skip
        self.masters, self.library, self.tech = masters, library, tech
        self.widths = {cell: round(area / tech.row_um, 4) for cell, area in areas.items()}
        self.rows = free_rows(placed, self.widths, tech.fill_cells, tech.site_um, tech.row_um)
        self.nets: list[str] = []
        self.fill = Counter[str]()

    def relieve(self, board: Board, net: str, gate: Box) -> bool:
        """Against what charges a ``gate`` (nm): a diode beside it; if it has one, a jumper. False where it has both."""
        number = board.pin_of(net, middle(gate))
        if number not in board.diodes[net].values() and self._put(board, net, number, gate):
            return True
        if number in board.jumpers[net]:
            return False
        board.jumpers[net].add(number)
        return True

    def _put(self, board: Board, net: str, number: int, gate: Box) -> bool:
        """Put a diode in place of fill; False where there is no room."""
        width, (x, y) = self.widths[DIODE], middle(gate)
        place = self.rows.take(width, x / 1000 - width / 2, y / 1000)
        if place is None:
            return False
        self._draw(board.top, place)
        one = Netlist("", (), (diode(net, len(self.nets)),))
        board.add_diode(net, pin_boxes(one, [[None, DIODE, *place]], self.masters)[net][0], number)
        self.nets.append(net)
        return True

    def _draw(self, top: "db.Cell", place: Place) -> None:
        """Let there be a diode at ``place``, and fill beside it where there was some in its way."""
        (x, y, orientation), fill, width = place, self.tech.fill_cells, self.widths[DIODE]
        rest, row = Rows(self.tech.site_um, self.tech.row_um), db.DBox(x, y, x + width, y).to_itype(top.layout().dbu)
        turn = transformation(top.layout(), *place).rot
        for instance in list(top.each_touching_inst(row)):
            cell, at = instance.cell, instance.dtrans.disp
            name = cell.name
            if (
                name in fill
                and instance.trans.rot == turn
                and round(at.y - y, 4) == 0
                and -self.widths[name] < round(at.x - x, 4) < width
            ):
                rest.give(self.widths[name], (at.x, y, orientation))
                instance.delete()
                if cell.is_top():  # that was the last one
                    cell.delete()
                self.fill[name] -= 1
        rest.take(width, x, y)
        filled = rest.filled({cell: self.widths[cell] for cell in fill})
        self.fill.update(cell for cell, _ in filled)
        for cell, at in [(DIODE, place), *filled]:
            insert(top, self.library, cell, *at)
