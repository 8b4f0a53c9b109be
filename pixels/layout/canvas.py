"""Shapes of a cell in um, on the manufacturing grid."""

from collections.abc import Iterable

from talbot.base.gds import db
from talbot.platforms.layers import GdsLayer
from talbot.platforms.pixel import PixelProcess

CONTACT_UM, CONTACT_OPENING_UM = 0.17, 0.10  # a contact's side; the nitride's cut around one to poly
LOCAL_END_UM = 0.08  # of the lowest metal beyond a contact, along one axis


class Canvas:
    """A cell that is drawn; ``mirror_um``: x of an axis, at which `Canvas.mirrored` draws what is given west of it."""

    def __init__(self, layout: "db.Layout", name: str, process: PixelProcess) -> None:
        self.layout, self.process = layout, process
        self.cell = layout.create_cell(name)
        self.axis_um: float | None = None

    def mirrored(self, axis_um: float | None) -> None:
        """Mirror everything drawn from here on about x = ``axis_um``; None: no mirroring."""
        self.axis_um = axis_um

    def box(self, mask: GdsLayer, left: float, bottom: float, right: float, top: float) -> None:
        """A rectangle, its edges rounded to the grid."""
        if self.axis_um is not None:
            left, right = 2 * self.axis_um - right, 2 * self.axis_um - left
        corners = (self.snap(value) for value in (left, bottom, right, top))
        self.cell.shapes(self.layout.layer(*mask)).insert(db.Box(*corners))

    def square(self, mask: GdsLayer, x: float, y: float, side: float) -> None:
        """A square around a point."""
        self.box(mask, x - side / 2, y - side / 2, x + side / 2, y + side / 2)

    def polygon(self, mask: GdsLayer, corners: Iterable[tuple[int, int]]) -> None:
        """A polygon with its corners in steps of the grid; it is not mirrored."""
        step = round(self.process.grid_um / self.layout.dbu)
        points = [db.Point(step * x, step * y) for x, y in corners]
        self.cell.shapes(self.layout.layer(*mask)).insert(db.Polygon(points))

    def label(self, level: int, text: str, x: float, y: float) -> None:
        """The name of a net on a metal, as pin and as label."""
        metal = self.process.metals[level]
        for numbers in (metal.pin, metal.label):
            at = db.Trans(self.snap(x), self.snap(y))
            self.cell.shapes(self.layout.layer(*numbers)).insert(db.Text(text, at))

    def wire(self, level: int, left: float, bottom: float, right: float, top: float) -> None:
        """A rectangle on metal ``level``."""
        self.box(self.process.metals[level].gds, left, bottom, right, top)

    def stack(self, x: float, y: float, low: int, high: int) -> None:
        """Vias from metal ``low`` up to metal ``high`` at a point, with their pads."""
        for level in range(low, high):
            via = self.process.vias[level]
            self.square(via.gds, x, y, via.size_um)
            below = via.enclosure_below_um or via.enclosure_um
            for metal, around in ((level, below), (level + 1, via.enclosure_um)):
                if metal or level:  # the lowest metal needs no more than the via, and has it from `contact`
                    self.square(self.process.metals[metal].gds, x, y, via.size_um + 2 * around)

    def contact(self, x: float, y: float, upright: bool = True) -> None:
        """A contact with the lowest metal over it, longer along y, or along x."""
        self.square(self.process.contact, x, y, CONTACT_UM)
        half = CONTACT_UM / 2
        across, along = (half, half + LOCAL_END_UM) if upright else (half + LOCAL_END_UM, half)
        self.wire(0, x - across, y - along, x + across, y + along)

    def poly_contact(self, x: float, y: float, upright: bool = True) -> None:
        """A contact to poly, in its opening of the nitride."""
        self.contact(x, y, upright)
        self.square(self.process.contact_poly, x, y, CONTACT_UM + 2 * CONTACT_OPENING_UM)

    def snap(self, um: float) -> int:
        """Return the database units of the grid point nearest to a length."""
        step = round(self.process.grid_um / self.layout.dbu)
        return step * round(um / self.process.grid_um)
