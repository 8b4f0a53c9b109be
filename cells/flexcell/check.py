"""Design rules and layout against schematic, by the KLayout application with the decks that PDKMaster exports."""

import collections
import xml.etree.ElementTree as ET
from pathlib import Path

from flow.jobs import Job, run
from flow.simulate.process import ToolError, finish


def check(folder, names, workers=-1):
    """Check every cell in ``folder`` (as cells.flexcell.write makes it): {name: {"drc": {rule: count}, "lvs": bool}}.

    Each cell's DRC and LVS alone, and once more the DRC of all side by side (name 'gallery'). Results are kept in
    folder/checks. Raises ToolError when KLayout is missing or leaves no report.
    """
    folder = Path(folder)
    gallery(folder, names)
    inputs = (folder / "decks/sky130.drc", folder / "decks/sky130.lvs", folder / "flexcell.spi")
    digest = {name: _content(folder, name) for name in names}
    jobs = [Job(name, check_cell, (str(folder), name), (*inputs, digest[name])) for name in names]
    jobs.append(Job("gallery", check_gallery, (str(folder),), (inputs[0], folder / "gallery.gds")))
    return dict(zip([*names, "gallery"], run(jobs, folder / "checks", "cells checked", workers), strict=True))


def gallery(folder, names):
    """folder/gallery.gds: every cell beside every kind of neighbour: rows of all cells in several orders, mirrored."""
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(Path(folder) / "flexcell.gds"))
    boundary = layout.layer(235, 4)
    top = layout.create_cell("gallery")
    boxes = {name: layout.cell(name).bbox_per_layer(boundary) for name in names}
    half = len(names) // 2
    orders = [names, names[::-1], names[half:] + names[:half], names[::2] + names[1::2]]
    for row, order in enumerate(orders):
        x, height = 0, boxes[names[0]].height()
        for name in order:
            turn = db.Trans(db.Trans.M0, x, (row + 1) * height) if row % 2 else db.Trans(db.Trans.R0, x, row * height)
            top.insert(db.CellInstArray(layout.cell(name).cell_index(), turn))
            x += boxes[name].width()
    for name in [cell.name for cell in layout.top_cells() if cell.name != "gallery"]:
        layout.delete_cell_rec(layout.cell(name).cell_index())
    options = db.SaveLayoutOptions()
    options.gds2_write_timestamps = False
    layout.write(str(Path(folder) / "gallery.gds"), options)


def check_cell(folder, name):
    """DRC and LVS of cell ``name``: dict."""
    return {"drc": _drc(Path(folder), Path(folder) / "flexcell.gds", name), "lvs": _lvs(Path(folder), name)}


def check_gallery(folder):
    return {"drc": _drc(Path(folder), Path(folder) / "gallery.gds", "gallery"), "lvs": True}


def _content(folder, name):
    """What a cell's GDS holds, as text."""
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(folder / "flexcell.gds"))
    return "".join(f"{info}{sorted(map(str, layout.cell(name).shapes(layout.layer(info)).each()))}"
                   for info in layout.layer_infos())


def _deck(folder, deck, name, environment):
    report = (folder / "reports" / f"{name}.{deck}.xml").absolute()
    report.parent.mkdir(exist_ok=True)
    report.unlink(missing_ok=True)
    done = finish(["klayout", "-b", "-r", folder / "decks" / f"sky130.{deck}"],
                  env={"REPORT_FILE": str(report), "CELL_NAME": name, "KLAYOUT_HOME": str(report.parent / ".klayout"),
                       **environment})
    if done.returncode and deck == "drc" or not report.exists():
        raise ToolError(f"klayout: {deck} of {name} failed: {(done.stderr or done.stdout).strip()[-300:]}")
    return report, done.stdout + done.stderr


def _drc(folder, gds, name):
    report, _ = _deck(folder, "drc", name, {"SOURCE_FILE": str(gds.absolute())})
    items = ET.parse(report).getroot().find("items")
    return dict(collections.Counter(item.findtext("category").strip("'") for item in items))


def _lvs(folder, name):
    _, words = _deck(folder, "lvs", name, {"SOURCE_FILE": str((folder / "flexcell.gds").absolute()),
                                           "SPICE_FILE": str((folder / "flexcell.spi").absolute())})
    return "LVS OK" in words
