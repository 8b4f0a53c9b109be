"""Design rules and layout against schematic, by the KLayout application with the decks that PDKMaster exports."""

import collections
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from talbot.base.gds import write_gds
from talbot.base.jobs import Job, run
from talbot.base.tools import ToolError, finish


class Checked(NamedTuple):
    """Violations of a cell by design rule, and whether its layout matches its netlist."""

    drc: dict[str, int]
    lvs: bool


def check(folder: Path, names: Sequence[str], workers: int = -1) -> dict[str, Checked]:
    """Check every cell in ``folder`` (written by cells.compact.write).

    DRC of all cells far apart and of all of them abutted in many orders (a rule broken between cells counts for
    'gallery'), LVS of each. Results are kept in folder/checks. Raises ToolError when KLayout is missing or fails.
    """
    _arrange(folder, names)
    drc, lvs = folder / "decks/sky130.drc", folder / "decks/sky130.lvs"
    spi, together = folder / "compact.spi", ("apart", "gallery")
    jobs = [Job(name, rules, (str(folder), name), (drc, folder / f"{name}.gds")) for name in together]
    jobs += [Job(name, matches, (str(folder), name), (lvs, spi, _content(folder, name))) for name in names]
    apart, abutted, *matching = run(jobs, folder / "checks", "cells checked", workers)
    result = {name: Checked(apart.get(name, {}), ok) for name, ok in zip(names, matching, strict=True)}
    others = [*abutted.values(), *(broken for cell, broken in apart.items() if cell not in names)]
    between = {rule: count for broken in others for rule, count in broken.items()}
    return result | {"gallery": Checked(between, True)}


def _arrange(folder: Path, names: Sequence[str]) -> None:
    """Write apart.gds (every cell alone) and gallery.gds (rows of all, abutted, mirrored, in several orders)."""
    import klayout.db as db

    half = len(names) // 2
    orders = [names, names[::-1], [*names[half:], *names[:half]], [*names[::2], *names[1::2]]]
    for top_name, rows, gap in (("apart", [names], 5000), ("gallery", orders, 0)):
        layout = db.Layout()
        layout.read(str(folder / "compact.gds"))
        boundary, top = layout.layer(235, 4), layout.create_cell(top_name)
        for row, order in enumerate(rows):
            x = 0
            for name in order:
                cell = layout.cell(name)
                box, mirrored = cell.bbox_per_layer(boundary), row % 2
                turn = db.Trans(db.Trans.M0 if mirrored else db.Trans.R0, x, (row + mirrored) * box.height())
                top.insert(db.CellInstArray(cell.cell_index(), turn))
                x += box.width() + gap
        for cell in [cell for cell in layout.top_cells() if cell.name != top_name]:
            layout.delete_cell_rec(cell.cell_index())
        write_gds(layout, folder / f"{top_name}.gds")


def rules(folder: str, name: str) -> dict[str, dict[str, int]]:
    """Violations in folder/<name>.gds by cell and rule."""
    source = Path(folder, f"{name}.gds").absolute()
    report, _ = _deck(Path(folder), "drc", name, {"SOURCE_FILE": str(source)})
    counts: dict[str, dict[str, int]] = {}
    for item in ET.parse(report).getroot().iterfind("items/item"):
        cell = counts.setdefault(item.findtext("cell", ""), collections.Counter())
        cell[item.findtext("category", "").strip("'")] += 1
    return counts


def matches(folder: str, name: str) -> bool:
    """Whether the layout of cell ``name`` has the transistors and nets of its netlist."""
    gds, spice = (str(Path(folder, f"compact.{suffix}").absolute()) for suffix in ("gds", "spi"))
    _, output = _deck(Path(folder), "lvs", name, {"SOURCE_FILE": gds, "SPICE_FILE": spice})
    return "LVS OK" in output


def _content(folder: Path, name: str) -> str:
    """The shapes of a cell's GDS as text."""
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(folder / "compact.gds"))
    shapes = {info: layout.cell(name).shapes(layout.layer(info)) for info in layout.layer_infos()}
    return "".join(f"{info}{sorted(map(str, same.each()))}" for info, same in shapes.items())


def _deck(folder: Path, deck: str, name: str, environment: Mapping[str, str]) -> tuple[Path, str]:
    report = (folder / "reports" / f"{name}.{deck}.xml").absolute()
    report.parent.mkdir(exist_ok=True)
    report.unlink(missing_ok=True)
    env = {"REPORT_FILE": str(report), "CELL_NAME": name, "KLAYOUT_HOME": str(report.parent / ".klayout")}
    done = finish(["klayout", "-b", "-r", folder / "decks" / f"sky130.{deck}"], env={**env, **environment})
    if done.returncode and deck == "drc" or not report.exists():
        raise ToolError(f"klayout: {deck} of {name} failed: {(done.stderr or done.stdout).strip()[-300:]}")
    return report, done.stdout + done.stderr
