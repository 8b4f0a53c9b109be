"""The sides of a block's pins, the places of its macros, and the room for its clock tree."""

import math
from collections.abc import Sequence
from itertools import combinations, pairwise, product
from typing import Any

from talbot.models.parameters import ParameterError
from talbot.platforms.coriolis import CoriolisPlatform
from talbot.platforms.frame import Frame

from ..netlist.netlist import Netlist
from .macro import Macro

BESIDE_UM = 15.0  # least width of rows beside a macro: a strap of either supply must find a place there
TREE_ASPECT = 1.8  # Coriolis cuts a longer box in two halves, whose trunks then overlap
HALO_ROWS = 3, 2  # heights of a row that are left free beside a macro, where its pins are met, and above it


def halo_area(macro: Macro, tech: CoriolisPlatform) -> float:
    """Area (um2) of a macro and its halo."""
    return _with_halo(macro, tech) * (macro.height_um + HALO_ROWS[1] * tech.row_um)


def _with_halo(macro: Macro, tech: CoriolisPlatform) -> float:
    """Width (um) of a macro and its halo, a multiple of a row's height, as the global router's cells are.

    A pin in a cell that is half taken is hard to route.
    """
    return round(math.ceil(macro.width_um / tech.row_um + 2 * HALO_ROWS[0] - 1e-9) * tech.row_um, 4)


def place_macros(
    macros: Sequence[tuple[str, Macro, tuple[float, float]]], width: float, height: float, tech: CoriolisPlatform
) -> list[dict[str, Any]]:
    """Place the ``macros``, (instance, Macro, shares of the width and height that are free to its west and south).

    Returns for each instance, cell, x_um, y_um, width_um, height_um, and outer, the box (um) with the halo. Raises
    ParameterError where macros overlap, or are above one another: their straps continue through the whole core.
    """
    made, row = [], tech.row_um
    for name, macro, (across, along) in macros:
        wide = _with_halo(macro, tech)
        left = round(across * (width - wide) / row) * row
        bottom = round(along * (height - macro.height_um) / row / 2) * 2 * row  # even: rails in line with rows'
        top = bottom + macro.height_um
        if left < 0 or bottom < 0 or top > height + 1e-6:
            size = f"{macro.width_um} x {macro.height_um} um"
            raise ParameterError(f"utilization: {name} of {size} does not fit into {width} x {height} um")
        beside, above = (rows * row for rows in HALO_ROWS)
        outer = left, max(0, bottom - above), left + wide, min(height, top + above)
        place = {"instance": name, "cell": macro.name, "x_um": round(left + beside, 4), "y_um": round(bottom, 4)}
        size = {"width_um": macro.width_um, "height_um": macro.height_um}
        made.append(place | size | {"outer": [round(value, 4) for value in outer]})
    ends = sorted((block["outer"][0], block["outer"][2], block["instance"]) for block in made)
    edges = [(0, 0, "the west edge"), *ends, (width, 0, "the east edge")]
    for (_, end, name), (begin, _, other) in pairwise(edges):
        if begin - end < BESIDE_UM:
            raise ParameterError(f"macros = {name}: must be {BESIDE_UM:g} um west of {other}, not {begin - end:.1f} um")
    return made


def framed(frame: Frame, origin: tuple[float, float], netlist: Netlist, tech: CoriolisPlatform) -> dict[str, Any]:
    """What a plan has of a ``frame``, in um from its core, which begins at ``origin`` in the frame.

    Raises ParameterError where the ports are not the netlist's.
    """
    own, wanted = {net for port in netlist.ports for net in port.bits()}, {name for name, _ in frame.ports}
    if own != wanted:
        raise ParameterError(
            f"ports = {', '.join(sorted(own ^ wanted)[:5])}: must be those of the frame, and only these"
        )
    (left, bottom), (width, length) = origin, frame.port_um
    top, metal = frame.height_um - bottom, next(metal.name for metal in tech.metals if metal.lef == frame.layer)

    def box(x: float) -> list[float]:
        """The box of the port at ``x`` in the frame."""
        return [round(value, 4) for value in (x - left - width / 2, top - length, x - left + width / 2, top)]

    return {
        "frame": [-left, -bottom, round(frame.width_um - left, 4), top],
        "ports": [[name, metal, box(x)] for name, x in frame.ports],
        "supplies": frame.supplies,
        "pins": {"north": [name for name, _ in sorted(frame.ports, key=lambda port: port[1])]},
    }


def largest_free(width: float, height: float, outers: Sequence[Sequence[float]]) -> list[float]:
    """The largest box of the core that meets none of ``outers``, no longer than TREE_ASPECT times its other side."""
    x = sorted({0.0, width, *(v for box in outers for v in (box[0], box[2]))})
    y = sorted({0.0, height, *(v for box in outers for v in (box[1], box[3]))})
    free = []
    for (left, right), (low, high) in product(combinations(x, 2), combinations(y, 2)):
        if not any(left < o[2] and o[0] < right and low < o[3] and o[1] < high for o in outers):
            free.append(_shorter(left, low, right, high))
    return max(free, key=lambda box: (box[2] - box[0]) * (box[3] - box[1]))


def _shorter(left: float, bottom: float, right: float, top: float) -> list[float]:
    """The box with its longer side cut by the same length at both ends."""
    across = max(0, right - left - TREE_ASPECT * (top - bottom)) / 2
    along = max(0, top - bottom - TREE_ASPECT * (right - left)) / 2
    return [round(v, 1) for v in (left + across, bottom + along, right - across, top - along)]
