"""The drawn pixel's response: its masks cut across the lines, and the cuts solved with all that is in them.

A pixel among its like, as in `optics.supercell`: windows, bars, frame, plate, lines of rows and columns, wells, and
light that walks from one half to the other or to the next pixel. A cut runs along the direction in which the type
modulates, until it repeats itself; the response is the mean of cuts side by side. Waves are taken as uniform along
the lines.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from talbot.base.gds import db
from talbot.models.parameters import ParameterError
from talbot.pixels.layout.pixel import PixelLayout, draw, openings
from talbot.pixels.optics.solve import Floats
from talbot.pixels.optics.supercell import Section, Spans, section_shares

DIRECTIONS = {0.0: (1, 0), 22.5: (2, 1), 45.0: (1, 1), 67.5: (1, 2), 90.0: (0, 1)}  # of cuts, in pixels
CUTS = 3  # of an oblique type, side by side; one of each opening where lines are upright or level
ORDERS_A_PERIOD, MOST_ORDERS = 11, 301
STEP = 0.042  # between the sines of angles, at most: a tenth of the period of beta 12
SINE = float(np.sin(np.deg2rad(33)))


@dataclass(frozen=True)
class DrawnCurves:
    """Response of both diodes of a drawn pixel along its own gratings, light without polarization.

    sines: (A,) of the angle in air, ascending. shares: (2, A) of the light on the pixel that reach each well.
    """

    sines: Floats
    shares: Floats


def drawn_curves(pixel: PixelLayout, wavelength_um: float) -> DrawnCurves:
    """Solve a drawn pixel. Raises ParameterError for a type at no angle of `DIRECTIONS`, SolverError."""
    sines, total = np.zeros(0), np.zeros(())
    for cut, weight in sections(pixel):
        orders = min(2 * int(ORDERS_A_PERIOD * cut.period_um / pixel.drawn.period_um / 2) + 1, MOST_ORDERS)
        offsets = int(np.ceil(wavelength_um / cut.period_um / STEP))
        sines, shares, _ = section_shares(pixel.geometry.stack, cut, wavelength_um, orders, offsets, SINE)
        total = total + weight * shares.mean(0)
    return DrawnCurves(sines, total)


def sections(pixel: PixelLayout) -> Iterator[tuple[Section, float]]:
    """Return cuts across a drawn pixel among neighbours of its type, and the share that each represents."""
    gamma = pixel.kind.gamma_deg
    if abs(gamma) not in DIRECTIONS:
        known = ", ".join(f"{angle:g}" for angle in DIRECTIONS)
        raise ParameterError(f"gamma_deg = {gamma:g}: must be one of {known}, of either sign, for a cut")
    across, up = DIRECTIONS[abs(gamma)]
    up = up if gamma < 0 else -up  # the sensor's y runs down, the layout's up
    layout = db.Layout()
    layout.dbu = 0.001
    cell = draw(layout, pixel).cell
    pitch = round(pixel.geometry.pitch_um / layout.dbu)
    top, reach = layout.create_cell("like"), 3
    shift = db.Trans(-reach * pitch, -reach * pitch)
    many = 2 * reach + 1
    top.insert(db.CellInstArray(cell.cell_index(), shift, db.Vector(pitch, 0), db.Vector(0, pitch), many, many))
    names = {metal.name for metal in pixel.geometry.stack.metals}
    masks = {metal.lef: metal.gds for metal in pixel.process.metals if metal.lef in names}
    metals = {name: db.Region(top.begin_shapes_rec(layout.layer(*mask))).merged() for name, mask in masks.items()}
    well = db.Region(cell.begin_shapes_rec(layout.layer(*pixel.process.well))).merged()
    halves = [db.Region(db.Box(side * pitch // 2, 0, (side + 1) * pitch // 2, pitch)) & well for side in (0, 1)]
    wells = [_tiled(half, pitch, reach) for half in halves]
    length = layout.dbu * pitch * float(np.hypot(across, up))
    for x, y, weight in _starts(pixel, across, up):
        start = db.DPoint(x, y).to_itype(layout.dbu)
        cut = db.Edge(start, start + db.Vector(across * pitch, up * pitch))
        spans = {name: _spans(cut, region, layout.dbu) for name, region in metals.items()}
        yield Section(length, spans, tuple(_spans(cut, region, layout.dbu) for region in wells)), weight


def _starts(pixel: PixelLayout, across: int, up: int) -> Iterator[tuple[float, float, float]]:
    """Yield the cuts' starts in um and their weights."""
    pitch = pixel.geometry.pitch_um
    boxes = [box for _, box in openings(pixel)][1:]
    if not up:  # all cuts through the openings are alike
        low, high = (sum(box[edge] for box in boxes) / 2 for edge in (1, 3))
        yield 0.0, (low + high) / 2, (high - low) / pitch
    elif not across:
        for left, _, right, _ in boxes:
            yield (left + right) / 2, 0.0, (right - left) / pitch
    else:
        for k in range(CUTS):
            at = (k + 0.5) / CUTS * pitch / max(abs(across), abs(up))
            yield (0.0, at, 1 / CUTS) if abs(across) >= abs(up) else (at, 0.0, 1 / CUTS)


def _tiled(region: "db.Region", pitch: int, reach: int) -> "db.Region":
    out = db.Region()
    for i in range(-reach, reach + 1):
        for k in range(-reach, reach + 1):
            out += region.moved(i * pitch, k * pitch)
    return out.merged()


def _spans(cut: "db.Edge", region: "db.Region", dbu: float) -> Spans:
    """Return the spans of a cut inside a region, from its start, in um."""
    parts = db.Edges([cut]).inside_part(region)
    length, ends = cut.length(), []
    for part in parts.each():
        ends.append(sorted((point - cut.p1).sprod(cut.d()) / length * dbu for point in (part.p1, part.p2)))
    return tuple((round(low, 3), round(high, 3)) for low, high in sorted(ends))
