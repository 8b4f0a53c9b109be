"""DEF and the cells' GDS -> one GDS, by KLayout's reader: OpenROAD itself writes none."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from talbot.base.gds import write_gds
from talbot.models.parameters import ParameterError
from talbot.platforms.place_and_route import PlaceAndRoute

DRAWN = "NET,SPNET,VIA,PIN,LEFPIN,FILL"


def layer_map(tech: PlaceAndRoute) -> str:
    """Text of a KLayout layer map: shapes to a layer's own datatype, pins and labels to those of the process."""
    lines = ["DIEAREA ALL {} {}".format(*tech.outline)]
    for name, (layer, datatype) in tech.gds.items():
        lines += [f"{name} {DRAWN} {layer} {datatype}", f"{name} PIN {layer} {tech.pin_datatype}"]
        lines.append(f"NAME {name}/PIN {layer} {tech.label_datatype}")
    return "\n".join([*lines, ""])


def merge(source: Path, lefs: Sequence[Path], cells: Path, tech: PlaceAndRoute, target: Path) -> tuple[float, float]:
    """Write the DEF file ``source`` as GDS ``target``. lefs: technology and cells; cells: their GDS.

    Returns (width, height) in um of the die. Raises ParameterError for a cell that has no layout.
    """
    import klayout.db as db

    options = db.LoadLayoutOptions()
    config = options.lefdef_config
    config.dbu, config.read_lef_with_def, config.lef_files = 0.001, False, [str(path) for path in lefs]
    config.macro_resolution_mode = 2  # a cell is what the GDS has, never what the LEF draws
    layout = db.Layout()
    with tempfile.NamedTemporaryFile("w", suffix=".map", encoding="utf-8") as layers:
        layers.write(layer_map(tech))
        layers.flush()
        config.map_file = layers.name
        layout.read(str(source), options)
    (top,) = (cell for cell in layout.top_cells() if not cell.is_empty() or cell.child_instances())
    used = {layout.cell(index).name for index in top.called_cells() if layout.cell(index).is_ghost_cell()}
    library = db.Layout()
    library.read(str(cells))
    lacking = sorted(name for name in used if not library.has_cell(name))
    if lacking:
        raise ParameterError(f"gds = {cells}: must have the cell {lacking[0]}")
    for name in sorted(used):
        layout.cell(name).copy_tree(library.cell(name))
    write_gds(layout, target, top)
    box = db.Region(top.shapes(layout.layer(*tech.outline))).bbox()
    return round(box.width() * layout.dbu, 3), round(box.height() * layout.dbu, 3)
