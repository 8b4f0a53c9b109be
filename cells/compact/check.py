"""Design rules and layout against schematic, by the KLayout application with the decks that PDKMaster exports."""

import collections
import xml.etree.ElementTree as ET
from pathlib import Path

from base.gds import write_gds
from base.jobs import Job, run
from base.tools import ToolError, finish


def check(folder, names, workers=-1):
    """Check every cell in ``folder`` (as cells.compact.write makes it): {name: {"drc": {rule: count}, "lvs": bool}}.

    DRC of all cells far apart and of all of them abutted in many orders (a rule broken between cells counts for
    'gallery'), LVS of each. Results are kept in folder/checks. Raises ToolError when KLayout is missing or fails.
    """
    folder = Path(folder)
    _arrange(folder, names)
    drc, lvs = folder / "decks/sky130.drc", folder / "decks/sky130.lvs"
    jobs = [Job(name, rules, (str(folder), name), (drc, folder / f"{name}.gds")) for name in ("apart", "gallery")]
    jobs += [
        Job(name, matches, (str(folder), name), (lvs, folder / "compact.spi", _content(folder, name))) for name in names
    ]
    apart, abutted, *lvs = run(jobs, folder / "checks", "cells checked", workers)
    result = {name: {"drc": apart.get(name, {}), "lvs": ok} for name, ok in zip(names, lvs, strict=True)}
    between = {
        rule: count
        for found in (abutted, {k: v for k, v in apart.items() if k not in names})
        for rules_ in found.values()
        for rule, count in rules_.items()
    }
    return result | {"gallery": {"drc": between, "lvs": True}}


def _arrange(folder, names):
    """folder/apart.gds: every cell alone; folder/gallery.gds: rows of all, abutted, mirrored, in several orders."""
    import klayout.db as db

    half = len(names) // 2
    orders = [names, names[::-1], names[half:] + names[:half], names[::2] + names[1::2]]
    for top_name, rows, gap in (("apart", [names], 5000), ("gallery", orders, 0)):
        layout = db.Layout()
        layout.read(str(folder / "compact.gds"))
        boundary = layout.layer(235, 4)
        top = layout.create_cell(top_name)
        for row, order in enumerate(rows):
            x = 0
            for name in order:
                cell = layout.cell(name)
                box = cell.bbox_per_layer(boundary)
                turn = (
                    db.Trans(db.Trans.M0, x, (row + 1) * box.height())
                    if row % 2
                    else db.Trans(db.Trans.R0, x, row * box.height())
                )
                top.insert(db.CellInstArray(cell.cell_index(), turn))
                x += box.width() + gap
        for cell in [cell for cell in layout.top_cells() if cell.name != top_name]:
            layout.delete_cell_rec(cell.cell_index())
        write_gds(layout, folder / f"{top_name}.gds")


def rules(folder, name):
    """{cell: {rule: violations}} of folder/<name>.gds."""
    folder = Path(folder)
    report, _ = _deck(folder, "drc", name, {"SOURCE_FILE": str((folder / f"{name}.gds").absolute())})
    found = {}
    for item in ET.parse(report).getroot().find("items"):
        cell = found.setdefault(item.findtext("cell"), collections.Counter())
        cell[item.findtext("category").strip("'")] += 1
    return found


def matches(folder, name):
    """Does the layout of cell ``name`` have the transistors and nets of its netlist?"""
    folder = Path(folder)
    _, words = _deck(
        folder,
        "lvs",
        name,
        {
            "SOURCE_FILE": str((folder / "compact.gds").absolute()),
            "SPICE_FILE": str((folder / "compact.spi").absolute()),
        },
    )
    return "LVS OK" in words


def _content(folder, name):
    """What a cell's GDS holds, as text."""
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(folder / "compact.gds"))
    return "".join(
        f"{info}{sorted(map(str, layout.cell(name).shapes(layout.layer(info)).each()))}"
        for info in layout.layer_infos()
    )


def _deck(folder, deck, name, environment):
    report = (folder / "reports" / f"{name}.{deck}.xml").absolute()
    report.parent.mkdir(exist_ok=True)
    report.unlink(missing_ok=True)
    done = finish(
        ["klayout", "-b", "-r", folder / "decks" / f"sky130.{deck}"],
        env={
            "REPORT_FILE": str(report),
            "CELL_NAME": name,
            "KLAYOUT_HOME": str(report.parent / ".klayout"),
            **environment,
        },
    )
    if done.returncode and deck == "drc" or not report.exists():
        raise ToolError(f"klayout: {deck} of {name} failed: {(done.stderr or done.stdout).strip()[-300:]}")
    return report, done.stdout + done.stderr
