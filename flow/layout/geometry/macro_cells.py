"""Macros in a routed layout: their black boxes, which stop other routers, and their own GDS in place of these."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from talbot.base.gds import db, read_gds, write_gds
from talbot.platforms.coriolis import CoriolisPlatform

from ..netlist.names import MACRO

OVER_UM = 0.4  # that routes of a macro may be over its edge: half a segment on a track there


def make_solid(gds: Path, macros: Sequence[dict[str, Any]], tech: CoriolisPlatform) -> None:
    """Block the ``macros`` (entries of Coriolis's request) on all layers but the lowest, except around their pins.

    The routers after Coriolis then find no path through a macro.
    """
    if not macros:
        return
    layout = read_gds(gds)
    for macro in macros:
        cell, (left, bottom, *_) = layout.cell(macro["name"]), macro["outer"]
        x, y = macro["x_um"] - left, macro["y_um"] - bottom
        solid = db.DBox(x - OVER_UM, y - OVER_UM, x + macro["width_um"] + OVER_UM, y + macro["height_um"] + OVER_UM)
        inside, distance = layout.create_cell(f"{macro['name']}_solid"), max(tech.pin_pitch_um.values())
        cell.insert(db.CellInstArray(inside.cell_index(), db.Trans()))
        for metal in tech.metals[1:]:
            layer = layout.layer(*metal.gds)
            pins = db.Region(cell.shapes(layer)).sized(round(distance / layout.dbu))
            inside.shapes(layer).insert(db.Region(solid.to_itype(layout.dbu)) - pins)
    write_gds(layout, gds)


def insert_macros(
    source: Path, target: Path, macros: Sequence[tuple[Path, dict[str, Any]]], tech: CoriolisPlatform
) -> None:
    """Write ``source`` as ``target`` with the macros' GDS in place of their black boxes.

    The segments at the pins move to the top cell. macros: (GDS, entry in the floorplan), in the floorplan's order.
    """
    layout, options = read_gds(source), db.LoadLayoutOptions()
    top = layout.top_cell()
    options.cell_conflict_resolution = db.LoadLayoutOptions.CellConflictResolution.SkipNewCell  # of the library
    for number, (path, macro) in enumerate(macros):
        box, (left, bottom, *_) = layout.cell(f"{MACRO}{number}"), macro["outer"]
        for part in (*tech.metals, *tech.vias):
            layer = layout.layer(*part.gds)
            x, y = round(left / layout.dbu), round(bottom / layout.dbu)
            top.shapes(layer).insert(db.Region(box.shapes(layer)).moved(x, y))
        layout.prune_cell(box.cell_index(), -1)
        if layout.cell(macro["cell"]) is None:
            layout.read(str(path), options)
        top.insert(db.DCellInstArray(layout.cell(macro["cell"]).cell_index(), db.DTrans(macro["x_um"], macro["y_um"])))
    write_gds(layout, target)
