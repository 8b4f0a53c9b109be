"""The tile, and the array: pixels of all types by hierarchy, dummies around them, guard rings, and ways to the pins.

From the pixels outwards: dummy rows and columns, whose pixels see the same neighbours as all others; a ring of taps of
the substrate, on the ground; a ring of n well, on the supply, that takes carriers which diffuse in from outside. Rows
end in the west, columns in the south, supplies in the east, at the pins of `talbot.pixels.blocks`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from talbot.base.gds import db
from talbot.models.parameters import ArrayParameters, ParameterError, TileParameters
from talbot.pixels.blocks import AnalogSizes, Block, pixel_array
from talbot.pixels.drawn import DUMMIES
from talbot.pixels.footprints import draw_pins
from talbot.pixels.layout.canvas import CONTACT_UM, Canvas
from talbot.pixels.layout.pixel import (
    COLUMN,
    COLUMNS,
    IMPLANT,
    LINE,
    PLATE,
    PLATES,
    READ_Y,
    RESET_Y,
    ROWS_ON,
    SHIELD,
    UPPER,
    PixelLayout,
    draw,
)
from talbot.platforms.layers import GdsLayer

WEST, SOUTH, EAST, NORTH = 10.0, 10.0, 30.0, 10.0  # um from the outline to the dummies
GROUND_RING, SUPPLY_RING = (1.0, 1.6), (3.5, 4.1)  # um from the dummies: taps
WELL_RING = 3.0, 4.6
GROUND_BUS, SUPPLY_BUS = (0.8, 8.0), (9.0, 17.0)  # um from the dummies in the east
TIE = 2.3  # um from the dummies, where a dummy row's reset line meets the supply
TURN = 3.0, 4.0  # um from the outline: where row and column lines change their metal
PAD = 0.16  # half of a via's pad on the rows' metal
CONTACT_PITCH = 1.0


@dataclass(frozen=True)
class ArrayLayout:
    """The input of an array's drawing. pixels: the tile's types, in order; all of one pitch and process."""

    array: ArrayParameters
    tile: TileParameters
    pixels: tuple[PixelLayout, ...]

    def __post_init__(self) -> None:
        if len(self.pixels) != self.tile.n_types:
            raise ParameterError(f"pixels = {len(self.pixels)}: must be one for each of {self.tile.n_types} types")
        if any(abs(pixel.geometry.pitch_um - self.array.pitch_um) > 1e-6 for pixel in self.pixels):
            raise ParameterError(f"pitch = {self.array.pitch:g}: must be that of every pixel's geometry")

    @property
    def pitch_um(self) -> float:
        """Pitch of the pixels."""
        return self.pixels[0].geometry.pitch_um

    @property
    def well_ring_um(self) -> tuple[float, float]:
        """Area in um2 and perimeter in um of the ring of n well."""
        block = self.block
        width, height = block.width_um - WEST - EAST, block.height_um - SOUTH - NORTH
        outer, inner = ((width + 2 * by, height + 2 * by) for by in reversed(WELL_RING))
        area = outer[0] * outer[1] - inner[0] * inner[1]
        return area, 2 * (sum(outer) + sum(inner))

    @property
    def block(self) -> Block:
        """Outline and pins: those of the black box, moved by what is around the pixels."""
        plain = pixel_array(self.array)
        west, south = WEST + DUMMIES * self.pitch_um, SOUTH + DUMMIES * self.pitch_um
        width = plain.width_um + 2 * DUMMIES * self.pitch_um + WEST + EAST
        height = plain.height_um + 2 * DUMMIES * self.pitch_um + SOUTH + NORTH
        pins = (replace(pin, at_um=pin.at_um + (west if pin.side == "south" else south)) for pin in plain.pins)
        return Block(plain.name, width, height, tuple(pins))


def draw_pixels(layout: "db.Layout", array: ArrayLayout) -> dict[int, "db.Cell"]:
    """Return a cell of every type, by its number; types with one drawing share it."""
    cells: dict[str, db.Cell] = {}
    for pixel in array.pixels:
        if pixel.name not in cells:
            cells[pixel.name] = draw(layout, pixel).cell
    return {number: cells[pixel.name] for number, pixel in enumerate(array.pixels)}


def draw_tile(layout: "db.Layout", array: ArrayLayout, cells: "Mapping[int, db.Cell]") -> "db.Cell":
    """One tile, row 0 in the north."""
    top = layout.create_cell("tile")
    tile, pitch = array.tile, round(array.pitch_um / layout.dbu)
    for place, number in enumerate(tile.order):
        row, col = divmod(place, tile.cols)
        at = db.Trans(col * pitch, (tile.rows - 1 - row) * pitch)
        top.insert(db.CellInstArray(cells[number].cell_index(), at))
    return top


def draw_array(layout: "db.Layout", array: ArrayLayout, cells: "Mapping[int, db.Cell]") -> "db.Cell":
    """Return the array, its south-west corner at the origin."""
    block, process = array.block, array.pixels[0].process
    canvas = Canvas(layout, block.name, process)
    _place(canvas, array, cells)
    draw_surroundings(canvas, array)
    _supplies(canvas, array)
    draw_pins(layout, canvas.cell, block, process.name, AnalogSizes().supply_um)
    canvas.box(process.outline, 0, 0, block.width_um, block.height_um)
    return canvas.cell


def draw_surroundings(canvas: Canvas, array: ArrayLayout) -> None:
    """Draw the surroundings of the pixels: rings, ends of rows and columns, buses of the supplies in the east.

    A shuttle fills what is less dense than its rules ask: over the diodes the fill would be a shade.
    """
    for mask in canvas.process.fill_blocks:
        canvas.box(mask, *inside(array))
    _rings(canvas, array)
    _ends(canvas, array)
    _buses(canvas, array)


def _place(canvas: Canvas, array: ArrayLayout, cells: "Mapping[int, db.Cell]") -> None:
    """All pixels: for every position in the tile one array of instances."""
    tile, rows, cols = array.tile, array.array.rows, array.array.cols
    for place, number in enumerate(tile.order):
        row, col = divmod(place, tile.cols)
        first_row, first_col = -DUMMIES + (row + DUMMIES) % tile.rows, -DUMMIES + (col + DUMMIES) % tile.cols
        down = len(range(first_row, rows + DUMMIES, tile.rows))
        across = len(range(first_col, cols + DUMMIES, tile.cols))
        x, y = corner(array, first_row, first_col)
        pitch = array.pitch_um
        _repeat(canvas, cells[number], (x, y), (tile.cols * pitch, across), (-tile.rows * pitch, down))


def corner(array: ArrayLayout, row: int, col: int) -> tuple[float, float]:
    """Return the south-west corner of a pixel, um; row -1 is a dummy's."""
    pitch = array.pitch_um
    return WEST + (col + DUMMIES) * pitch, SOUTH + (array.array.rows + DUMMIES - 1 - row) * pitch


def _repeat(
    canvas: Canvas, cell: "db.Cell", at: tuple[float, float], along_x: tuple[float, int], along_y: tuple[float, int]
) -> None:
    """Instances of a cell: pitch in um and number along x and along y."""
    (step_x, across), (step_y, up) = along_x, along_y
    if across and up:
        vectors = db.Vector(canvas.snap(step_x), 0), db.Vector(0, canvas.snap(step_y))
        trans = db.Trans(canvas.snap(at[0]), canvas.snap(at[1]))
        canvas.cell.insert(db.CellInstArray(cell.cell_index(), trans, *vectors, across, up))


def inside(array: ArrayLayout) -> tuple[float, float, float, float]:
    """Left, bottom, right, top of all pixels, dummies among them."""
    block = array.block
    return WEST, SOUTH, block.width_um - EAST, block.height_um - NORTH


def _rings(canvas: Canvas, array: ArrayLayout) -> None:
    process = canvas.process
    local = process.metals[0].gds
    canvas_of = Canvas(canvas.layout, "ring_contact", process)
    canvas_of.square(process.contact, 0, 0, CONTACT_UM)
    for implant, (near, far) in ((process.pplus, GROUND_RING), (process.nplus, SUPPLY_RING)):
        _ring(canvas, array, process.tap, near, far)
        _ring(canvas, array, local, near, far)
        _ring(canvas, array, implant, near - IMPLANT, far + IMPLANT)
        middle = (near + far) / 2
        left, bottom, right, top = inside(array)
        across, up = int((right - left) / CONTACT_PITCH), int((top - bottom) / CONTACT_PITCH)
        for y in (bottom - middle, top + middle):
            _repeat(canvas, canvas_of.cell, (left + 0.5, y), (CONTACT_PITCH, across), (CONTACT_PITCH, 1))
        for x in (left - middle, right + middle):
            _repeat(canvas, canvas_of.cell, (x, bottom + 0.5), (CONTACT_PITCH, 1), (CONTACT_PITCH, up))
    _ring(canvas, array, process.well, *WELL_RING)


def _ring(canvas: Canvas, array: ArrayLayout, mask: GdsLayer, near: float, far: float) -> None:
    """A mask all around the pixels, from ``near`` to ``far`` um from them."""
    left, bottom, right, top = inside(array)
    for low, high in ((bottom - far, bottom - near), (top + near, top + far)):
        canvas.box(mask, left - far, low, right + far, high)
    for low, high in ((left - far, left - near), (right + near, right + far)):
        canvas.box(mask, low, bottom - far, high, top + far)


def _ends(canvas: Canvas, array: ArrayLayout) -> None:
    """Draw the lines from rows and columns to their pins; the lines of dummy rows are tied off."""
    pitch, (rows, cols) = array.pitch_um, (array.array.rows, array.array.cols)
    row, dummy, column = (
        Canvas(canvas.layout, name, canvas.process) for name in ("row_end", "dummy_end", "column_end")
    )
    pins = {pin.name: pin.at_um for pin in array.block.pins}
    _, y0 = corner(array, 0, 0)
    for name, y in (("pixel_reset_row[0]", RESET_Y), ("read_row[0]", READ_Y)):
        at = canvas.snap(pins[name] - y0) * canvas.layout.dbu  # as vias are
        row.wire(PLATES, 0, at - LINE, TURN[0] + LINE, at + LINE)
        row.stack(TURN[0], at, ROWS_ON, PLATES)
        row.wire(ROWS_ON, TURN[0] - PAD, min(at, y) - LINE / 2, TURN[0] + PAD, max(at, y) + LINE / 2)
        row.wire(ROWS_ON, TURN[0] - LINE / 2, y - LINE / 2, WEST, y + LINE / 2)
    dummy.wire(ROWS_ON, WEST - TIE, RESET_Y - LINE / 2, WEST, RESET_Y + LINE / 2)
    dummy.stack(WEST - TIE, RESET_Y, ROWS_ON, PLATES)
    dummy.wire(PLATES, WEST - TIE - LINE, PLATE[0] - LINE, WEST, PLATE[1])
    ground = WEST - sum(GROUND_RING) / 2
    dummy.wire(ROWS_ON, ground, READ_Y - LINE / 2, WEST, READ_Y + LINE / 2)
    dummy.stack(ground, READ_Y, 0, ROWS_ON)
    _repeat(canvas, row.cell, (0, SOUTH + DUMMIES * pitch), (pitch, 1), (pitch, rows))
    for y in (SOUTH, SOUTH + (rows + DUMMIES) * pitch):
        _repeat(canvas, dummy.cell, (0, y), (pitch, 1), (pitch, DUMMIES))
    x0, _ = corner(array, 0, 0)
    for name, x in (("column_a[0]", pitch / 2 - COLUMN), ("column_b[0]", pitch / 2 + COLUMN)):
        at = canvas.snap(pins[name] - x0) * canvas.layout.dbu
        column.wire(UPPER, at - LINE, 0, at + LINE, TURN[1] + LINE)
        column.stack(at, TURN[1], COLUMNS, UPPER)
        column.square(canvas.process.metals[PLATES].gds, at, TURN[1], 0.5)  # a via's pad is below the least area
        column.wire(COLUMNS, min(at, x) - LINE / 2, TURN[1] - LINE / 2, max(at, x) + LINE / 2, TURN[1] + LINE / 2)
        column.wire(COLUMNS, x - LINE / 2, TURN[1] - LINE / 2, x + LINE / 2, SOUTH)
    _repeat(canvas, column.cell, (WEST + DUMMIES * pitch, 0), (pitch, cols), (pitch, 1))


def _buses(canvas: Canvas, array: ArrayLayout) -> None:
    """Draw buses of ground and supply over the rings, in the east."""
    process, pitch = canvas.process, array.pitch_um
    _, bottom, right, _ = inside(array)
    end = Canvas(canvas.layout, "supply_end", process)
    for low, high in (GROUND_BUS, SUPPLY_BUS):
        end.wire(UPPER, low, 0, high, pitch)
    end.wire(UPPER, 0, SHIELD[0], GROUND_BUS[0], SHIELD[1])
    end.wire(PLATES, 0, PLATE[0], SUPPLY_BUS[1], PLATE[1])
    for step in range(6):
        end.stack(SUPPLY_BUS[0] + 1 + step, sum(PLATE) / 2, PLATES, UPPER)
    end.stack(sum(SUPPLY_RING) / 2, sum(PLATE) / 2, 0, PLATES)
    x, y = sum(GROUND_RING) / 2, pitch / 2 + 1
    end.stack(x, y, 0, UPPER)
    end.square(process.metals[PLATES].gds, x, y, 0.5)
    _repeat(canvas, end.cell, (right, bottom), (pitch, 1), (pitch, array.array.rows + 2 * DUMMIES))


def _supplies(canvas: Canvas, array: ArrayLayout) -> None:
    """Draw top metal from the buses to the pins."""
    _, _, right, _ = inside(array)
    via, half = canvas.process.vias[UPPER], AnalogSizes().supply_um / 2
    for pin in array.block.pins:
        if pin.supply:
            low, high = SUPPLY_BUS if pin.name == "vdda" else GROUND_BUS
            canvas.wire(UPPER + 1, right + low, pin.at_um - half, array.block.width_um, pin.at_um + half)
            step = via.size_um + via.space_um
            for k in range(4):
                for n in range(4):
                    x, y = right + low + 1.2 + k * step, pin.at_um - half + 1.2 + n * step
                    canvas.square(via.gds, round(x, 2), round(y / 0.01) * 0.01, via.size_um)
