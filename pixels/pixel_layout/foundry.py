"""The foundry's own decks over the drawn pixels, from a PDK that PDK_ROOT has.

KLayout's deck is run on all files. Magic keeps shapes as tiles at multiples of 45 degrees and counts widths and spaces
of others wrongly, so that it checks `STRAIGHT`: the types whose lines are at such angles, next to one another.
"""

import json
from collections.abc import Mapping
from pathlib import Path

from talbot.base.gds import db, read_gds, write_gds
from talbot.pixels.layout.array import ArrayLayout, draw_pixels
from talbot.signoff.foundry_drc import FoundryDrc, FoundryDrcParameters, MagicDrc

CHECKED = "pixel.gds", "tile.gds", "small_array.gds"
STRAIGHT = "straight.gds"
REPORTS = STRAIGHT, *(name.replace(".gds", ".foundry.lyrdb") for name in CHECKED), "straight.magic.txt"
Counts = dict[str, dict[str, int]]  # file, rule


def check(array: ArrayLayout, pdk: str, folder: Path, decks: Mapping[str, Path]) -> dict[str, Counts]:
    """Violations by deck ('klayout', 'magic'), file of ``folder`` and rule. decks: see `foundry.installed`.

    Raises StepError for a deck that fails.
    """
    out: dict[str, Counts] = {}
    if "klayout" in decks:
        out["klayout"] = {name: _klayout(folder / name, pdk, decks["klayout"]) for name in CHECKED}
    if "magic" in decks:
        draw_straight(array, folder / STRAIGHT)
        out["magic"] = {STRAIGHT: _magic(folder / STRAIGHT, pdk, decks["magic"])}
    return out


def draw_straight(array: ArrayLayout, gds: Path) -> None:
    """Write the types whose lines are at multiples of 45 degrees, in a row."""
    layout = db.Layout()
    layout.dbu = 0.001
    cells, top = draw_pixels(layout, array), layout.create_cell("straight")
    straight = [number for number, pixel in enumerate(array.pixels) if pixel.kind.gamma_deg % 45 == 0]
    pitch = round(array.pitch_um / layout.dbu)
    for place, number in enumerate(straight):
        top.insert(db.CellInstArray(cells[number].cell_index(), db.Trans(place * pitch, 0)))
    write_gds(layout, gds, top)


def _klayout(gds: Path, pdk: str, deck: Path) -> dict[str, int]:
    outputs = {"report": gds.with_suffix(".foundry.lyrdb"), "summary": gds.with_suffix(".foundry.json")}
    FoundryDrc(FoundryDrcParameters(pdk, _top(gds))).run({"gds": gds, "deck": deck}, outputs)
    return json.loads(outputs["summary"].read_text(encoding="utf-8"))


def _magic(gds: Path, pdk: str, technology: Path) -> dict[str, int]:
    report = gds.with_suffix(".magic.txt")
    MagicDrc(FoundryDrcParameters(pdk, _top(gds))).run({"gds": gds, "magic": technology}, {"report": report})
    rows = (line.split("\t", 1) for line in report.read_text(encoding="utf-8").splitlines()[:-1])
    return {rule: int(count) for count, rule in rows}


def _top(gds: Path) -> str:
    layout = read_gds(gds)
    return layout.top_cell().name


def total(found: Mapping[str, Mapping[str, Mapping[str, int]]]) -> int:
    """Violations of all decks and files."""
    return sum(count for files in found.values() for rules in files.values() for count in rules.values())
