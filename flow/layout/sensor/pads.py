"""Pads with ESD clamps: c4m-flexio's cells, flat, with the masks that PDKMaster's technology leaves out."""

import re
from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from typing import Any, NamedTuple

from talbot.base.gds import db
from talbot.platforms.layers import GdsLayer
from talbot.platforms.pads import PadProcess
from talbot.platforms.patience import imported, patience
from talbot.platforms.pixel import PixelProcess

# SkyWater's periphery rules, nm
OPENING, OPENING_SPACE = 100, 270  # npc around a contact to poly, and between two (licon.15, npc.2)
TIP, TIP_SPACE = 185, 700  # hvntm around thick-oxide n+ diffusion and from other, and between two (hvntm.2, 3, 6a)
IMPLANT, ENCLOSURE, APART = (
    110,
    125,
    130,
)  # psdm from contacts to poly, around its diffusion, from n+: licon.9, psd.5, 7
CLEAR, LEAST = IMPLANT + ENCLOSURE, 380  # contacts to poly from p+ diffusion; width and space of implants (psd.1, 2)
SPACES = 210, 170  # of poly and of local interconnect: what is nearer around a moved contact is filled (poly.2, li.3)
SHORT = 10  # what the level shifter to the core has too little room for hvntm between its two n transistors
THICK_LEAST, THICK_APART, THICK_ROOM = 290, 370, 330  # in thick oxide: diffusion, p+ from n+, n well around a tap
GROWN = 30  # of a tap of 250 on each side: one has a transistor 340 nm off
GRID, SLIVER = 5, 15  # half of what corners leave of a region that is opened
ROW = "pads"
GROUNDS = "vss", "iovss"
AROUND = (
    ((80, 50), (50, 80)),
    ((80, 0), (0, 80)),
)  # nm of poly and of local interconnect around a contact: licon.8, li.5


class _Well(NamedTuple):
    """A well of a cell. name: the same of wells that abut. thick, thin: it has thick oxide, thin-oxide transistors."""

    cell: "db.Cell"
    region: "db.Region"
    name: tuple[int, int, int]
    thick: bool
    thin: bool


def library(process: PadProcess) -> tuple[Any, Any]:
    """PDKMaster's libraries with all layouts drawn: of the pads, and of the gates in them."""
    io = imported(process.module)
    made = import_module("pdkmaster.design.library").Library(name="IOLib", tech=io.tech)
    with patience():
        drawing = getattr(import_module(process.drawing), process.factory)
        factory = drawing(lib=made, cktfab=io.cktfab, layoutfab=io.layoutfab)
        assert factory.get_cell("Gallery").circuit  # asked for, it makes all cells
        assert all(factory.get_cell(name).layout for name in process.cells)
    return made, factory.spec.stdcellfab.lib


def layout(made: Any, process: PadProcess, pixel: PixelProcess) -> "db.Layout":
    """The pads' GDS, each flat and mended; only its own pins have names."""
    from pdkmaster.io.klayout import export2db

    gds_layers = import_module(f"{process.package}.pdkmaster").gds_layers
    found = export2db(made, gds_layers=gds_layers, cell_name=None, merge=False, add_pin_label=True)
    pads = [found.cell(name) for name in process.cells]
    wanted = {cell.cell_index() for cell in pads}
    names = {metal.pin_datatype for metal in pixel.metals}
    for cell in found.each_cell():
        if cell.cell_index() not in wanted:
            for index in found.layer_indexes():
                if found.get_info(index).datatype in names:
                    cell.clear(index)
    for cell in pads:
        cell.flatten(True)
        mend(cell, pixel)
        split(cell, pixel, process.tap)
    cover_wells(pads, pixel, process.tap)
    others = [cell.cell_index() for cell in found.each_cell() if cell.cell_index() not in wanted]
    found.delete_cells(others)
    return found


def mend(cell: "db.Cell", process: PixelProcess) -> None:
    """Add the nitride's openings and the tip implant; make room for them where PDKMaster's rules leave none.

    Contacts to poly move away from p diffusion; the implants end before contacts to poly and diffusion of the other
    kind.
    """
    _clear_poly_contacts(cell, process)
    active, poly, contact = (_region(cell, mask) for mask in (process.active, process.poly, process.contact))
    nplus, pplus = _region(cell, process.nplus), _region(cell, process.pplus)
    n_thick = _thick(cell, process)
    other = (active - n_thick).merged()
    thin = (other & nplus) - _region(cell, process.well)
    beside = ((other - thin).edges() - n_thick.edges()).extended_out(TIP) + thin.edges().extended_out(TIP - SHORT)
    _replace(cell, process.thick[1][0], _closed(n_thick.sized(TIP), TIP_SPACE) - other - (beside - n_thick))
    on_poly = contact.interacting(poly)
    _replace(cell, process.contact_poly, _closed(on_poly.sized(OPENING), OPENING_SPACE))
    n_active, p_active = active & nplus, active & pplus
    cut = _closed(on_poly.sized(2 * IMPLANT), LEAST).merged().extents()
    for mask, implant, own, far in (
        (process.nplus, nplus, n_active, p_active.sized(APART)),
        (process.pplus, pplus, p_active, n_active.sized(APART) + cut),
    ):
        kept = own.sized(ENCLOSURE) & implant
        left = _opened(implant - (far - kept), LEAST)
        made = (left + kept).merged()
        _replace(cell, mask, made + (_closed(made, LEAST) - on_poly.sized(IMPLANT) - (far - cut)))


def split(cell: "db.Cell", process: PixelProcess, tap: GdsLayer) -> None:
    """Taps on their own mask; PDKMaster draws them on that of diffusion."""
    active, well = _region(cell, process.active), _region(cell, process.well)
    nplus, pplus = (active & _region(cell, mask) for mask in (process.nplus, process.pplus))
    taps = (nplus & well) + (pplus - well)
    _replace(cell, tap, taps)
    _replace(cell, process.active, active - taps)


def cover_wells(cells: "Sequence[db.Cell]", process: PixelProcess, tap: GdsLayer) -> None:
    """Extend thick oxide over all of a well that it is in (nwell.9), into the cells beside it, too.

    Not over a well with thin-oxide transistors, as IOPadIn's level shifter has: they would be of thick oxide.
    """
    mask, wells = process.thick[0][0], list[_Well]()
    for number, cell in enumerate(cells):
        thick = _region(cell, mask)
        gates = (_region(cell, process.active) & _region(cell, process.poly)) - thick
        for polygon in _region(cell, process.well).each():
            well, box = db.Region(polygon), polygon.bbox()
            edge = (well & db.Region(db.Box(0, box.bottom, GRID, box.top))).bbox()
            name = (-1, edge.bottom, edge.top) if not edge.empty() else (number, box.left, box.bottom)
            wells.append(_Well(cell, well, name, not (thick & well).is_empty(), not (gates & well).is_empty()))
    covered = {one.name for one in wells if one.thick} - {one.name for one in wells if one.thin}
    for cell in cells:
        own = [one.region for one in wells if one.cell is cell and one.name in covered]
        if own:
            well = _widened(cell, process, tap, sum(own, db.Region()).merged())
            _replace(cell, process.well, _region(cell, process.well) + well)
            _replace(cell, mask, _closed((_region(cell, mask) + well).merged(), TIP_SPACE).merged())


def _widened(cell: "db.Cell", process: PixelProcess, tap: GdsLayer, well: "db.Region") -> "db.Region":
    """A well as thick oxide wants it; its diffusion becomes wide enough, its taps part from diodes."""
    apart = db.Region()
    for mask, implant in ((process.active, process.pplus), (tap, process.nplus)):
        whole = _region(cell, mask)
        inside = (whole & well).merged()
        narrow = inside.interacting((inside - _opened(inside, THICK_LEAST - 2 * GRID)).sized(-SLIVER))
        made = (_grown(narrow, GROWN) + inside - apart).merged()
        _replace(cell, mask, (whole - inside + made).merged())
        _replace(cell, implant, (_region(cell, implant) + _grown(made.interacting(narrow), ENCLOSURE)).merged())
        apart = _grown(made.not_interacting(_region(cell, tap)), THICK_APART)
    return (well + _grown((_region(cell, tap) & well).merged(), THICK_ROOM)).merged()


def _grown(region: "db.Region", by: int) -> "db.Region":
    """The region and ``by`` nm around it; diagonal edges stay on the grid."""
    return region.minkowski_sum(db.Box(-by, -by, by, by)).merged()


def _thick(cell: "db.Cell", process: PixelProcess) -> "db.Region":
    """Thick-oxide n+ diffusion."""
    active, nplus, well = (_region(cell, mask) for mask in (process.active, process.nplus, process.well))
    return ((active & nplus & _region(cell, process.thick[0][0])) - well).merged()


def _opened(region: "db.Region", width: int) -> "db.Region":
    """The region without what is not wider than ``width``."""
    return region.sized(-(width // 2)).sized(width // 2)


def _closed(region: "db.Region", space: int) -> "db.Region":
    """The region without gaps of less than ``space``; pieces that are diagonally nearer become one rectangle."""
    grown = region.sized(space // 2).merged()
    closed = grown.sized(-(space // 2)).merged()
    near = [one for one in grown.each() if (closed & db.Region(one)).merged().count() > 1]
    return closed + _boxes(one.bbox().enlarged(-(space // 2), -(space // 2)) for one in near)


def _clear_poly_contacts(cell: "db.Cell", process: PixelProcess) -> None:
    """Move contacts to poly away from p diffusion that is nearer than CLEAR."""
    contact, poly = _region(cell, process.contact), _region(cell, process.poly)
    diffusion = _region(cell, process.active) & _region(cell, process.pplus)
    near = contact.interacting(poly).interacting(diffusion.sized(CLEAR))
    ways = [
        (one.bbox(), _way(lambda box: (db.Region(box.enlarged(CLEAR, CLEAR)) & diffusion).is_empty(), one.bbox()))
        for one in near.each()
    ]
    _move(cell, ways, process)


def _move(cell: "db.Cell", ways: "Sequence[tuple[db.Box, db.Vector]]", process: PixelProcess) -> None:
    """Move contacts to poly; poly and local interconnect grow by the least that they must be around each."""
    if not ways:
        return
    old, new = _boxes(box for box, _ in ways), _boxes(box.moved(way) for box, way in ways)
    _replace(cell, process.contact, (_region(cell, process.contact) - old) + new)
    for mask, space, around in zip((process.poly, process.metals[0].gds), SPACES, AROUND, strict=True):
        layer, more = _region(cell, mask), db.Region()
        for box, way in ways:
            rooms = [box.moved(way).enlarged(*by) for by in around]
            near = space - GRID
            more.insert(
                min(
                    rooms,
                    key=lambda room: (
                        layer.interacting(db.Region(room.enlarged(near, near))).count(),
                        (db.Region(room) - layer).area(),
                    ),
                )
            )
        made, half = (layer + more).merged(), space // 2 - 1  # a gap of the least space stays
        notches = (made.sized(half).sized(-half) - made) & more.sized(space)
        for notch in notches.each():
            if made.interacting(db.Region(notch)).count() == 1:  # else it would join two nets
                more.insert(notch)
        _replace(cell, mask, made + more)


def _way(fits: "Callable[[db.Box], bool]", box: "db.Box") -> "db.Vector":
    """The shortest way along an axis that takes ``box`` to where it fits."""
    steps = range(GRID, CLEAR + GRID, GRID)
    ways = (db.Vector(x * step, y * step) for step in steps for x, y in ((0, 1), (0, -1), (1, 0), (-1, 0)))
    return next(way for way in ways if fits(box.moved(way)))


def _boxes(boxes: "Iterable[db.Box]") -> "db.Region":
    region = db.Region()
    for box in boxes:
        region.insert(box)
    return region


def _region(cell: "db.Cell", mask: GdsLayer) -> "db.Region":
    return db.Region(cell.begin_shapes_rec(cell.layout().layer(*mask))).merged()


def _replace(cell: "db.Cell", mask: GdsLayer, region: "db.Region") -> None:
    index = cell.layout().layer(*mask)
    for shape in [shape for shape in cell.shapes(index).each() if not shape.is_text()]:
        shape.delete()
    cell.shapes(index).insert(region)


def pins(cell: "db.Cell", process: PixelProcess) -> dict[str, list[list[int]]]:
    """Pin -> [level of the metal, left, bottom, right, top] of its shapes, nm; level 0 is the lowest metal."""
    found: dict[str, list[list[int]]] = {}
    for level, metal in enumerate(process.metals):
        shapes = cell.shapes(cell.layout().layer(*metal.pin))
        boxes = [shape.bbox() for shape in shapes.each() if not shape.is_text()]
        for shape in shapes.each():
            if shape.is_text():
                at = shape.text.position()
                box = next(box for box in boxes if box.contains(at))
                found.setdefault(shape.text.string, []).append([level, box.left, box.bottom, box.right, box.top])
    return found


def width_um(name: str, process: PadProcess) -> float:
    """Width of a pad or a filler along its side."""
    return next((um for um, cell in process.fillers.items() if cell == name), process.width_um)


def row(found: "db.Layout", process: PadProcess) -> "db.Cell":
    """A cell of all pads and fillers side by side between two corners."""
    top, x = found.create_cell(ROW), 0
    corner = found.cell(process.corner).cell_index()
    top.insert(db.CellInstArray(corner, db.Trans()))
    for name in (name for name in process.cells if name != process.corner):
        top.insert(db.CellInstArray(found.cell(name).cell_index(), db.Trans(x, 0)))
        x += round(1000 * width_um(name, process))
    top.insert(db.CellInstArray(corner, db.Trans(db.Trans.M90, x, 0)))
    return top


def joined(spice: str, process: PadProcess) -> str:
    """SPICE in which the grounds of a pad are one net, as the substrate makes of them."""

    def join(match: "re.Match[str]") -> str:
        """The subcircuit with one ground, if it is a pad."""
        head, *rest = match[0].split("\n")
        if head.split()[1] not in process.cells:
            return match[0]
        ports = [word for word in head.split() if word != GROUNDS[1]]
        return "\n".join([" ".join(ports), *(re.sub(rf"\b{GROUNDS[1]}\b", GROUNDS[0], line) for line in rest)])

    return re.sub(r"(?ms)^\.subckt .*?^\.ends", join, spice)
