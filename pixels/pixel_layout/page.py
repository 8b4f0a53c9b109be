"""The page of the drawn pixel: pictures, checks, drawn and solved dimensions."""

import io
from typing import Any

from PIL import Image

from talbot.base import page
from talbot.base.charts import save, svg
from talbot.base.page import TABLES, Picture, Section, Tile
from talbot.pixels.designs import gratings
from talbot.pixels.layout.array import DUMMIES
from talbot.pixels.pixel_layout import pictures
from talbot.pixels.pixel_layout.made import SMALL, Made
from talbot.platforms.wires import CORNERS

PICTURES = {
    "cross_section": (
        "A pixel, cut across its gratings",
        "Drawn to scale; between the gratings the light of a wave on the "
        "axis, solved: one diode's analyzer passes it, the other's does not.",
    ),
    "tile": (
        "The tile",
        "24 types: three periods, eight orientations, two analyzers; bars between pixels, frames over the diodes.",
    ),
}
NAMES = ("pixel_layout.html", *(f"{name}.png" for name in PICTURES))


def write(made: Made, s: dict[str, Any]) -> None:
    """Write the page and its pictures next to the files of ``made``."""
    process = made.shown.process
    figures = {
        "cross_section": pictures.cross_section(
            made.path("pixel.gds"), made.shown, gratings(s["process"]).wavelength_um
        ),
        "tile": pictures.tile(made.path("tile.gds"), process),
    }
    shown = []
    for name, figure in figures.items():
        save(figure, made.path(f"{name}.png"))
        image = Image.open(io.BytesIO(made.path(f"{name}.png").read_bytes()))
        shown.append(Picture(name, *PICTURES[name], image))
    text = page.render(
        TABLES,
        f"{s['process']}: the angle-sensitive pixel drawn",
        picture=shown[1].image,
        about=f"{s['rows']} x {s['cols']} pixels; make pixel-layout",
        tiles=_tiles(s),
        sections=[Section(pictures=shown), *_sections(s)],
    )
    made.path("pixel_layout.html").write_text(text, encoding="utf-8")


def _tiles(s: dict[str, Any]) -> list[Tile]:
    same = all(s["lvs_match"].values())
    waived = waivers(s)
    kind = "bad" if s["drc_violations"] else "none" if s["waivers"] else "good"
    return [
        Tile(str(s["drc_violations"]), f"violations of design rules{f', {waived}' if waived else ''}", kind),
        Tile("matches" if same else "differs", "layout against circuit", "good" if same else "bad"),
        Tile(f"{100 * s['fill_factor']:.0f} %", "of a pixel is photodiode"),
        Tile(f"{s['gds_bytes'] / 1e6:.2f} MB", f"GDS of {s['pixels']:,} pixels, in {s['gds_s']:.1f} s"),
    ]


def waivers(s: dict[str, Any]) -> str:
    """Return how many violations of which rules are waived, '' for none."""
    counts = {rule: one["count"] for rule, one in s["waivers"].items()}
    return f"{sum(counts.values()):,} more are waived ({', '.join(counts)})" if counts else ""


def _sections(s: dict[str, Any]) -> list[Section]:
    rows, cols = SMALL
    return [
        Section(
            "Design rules",
            f"PDKMaster's deck, the masks' and the pixels' own rules, over {rows} x {cols} pixels with {DUMMIES} "
            "dummies on each side, rings, buses and pins: every type with all of its neighbours. What is waived:",
            head=("rule", "count", "reason"),
            rows=[(rule, str(one["count"]), one["reason"]) for rule, one in s["waivers"].items()],
            numbers=False,
        ),
        Section(
            "The foundry's rules",
            "Violations by the decks of the PDK that PDK_ROOT has; Magic's, where lines are at multiples of 45 degrees."
            if s["foundry"]
            else "Not run: PDK_ROOT has no installed PDK.",
            head=("deck", "file", "rule", "count"),
            rows=[
                row
                for deck, files in s["foundry"].items()
                for name, f in files.items()
                for row in _broken(deck, name, f)
            ],
            numbers=False,
        ),
        Section(
            "What the drawn pixel does to light",
            "The drawn masks, cut across the lines and solved rigorously, compared with infinite gratings of the same "
            "diodes, -20..20 degrees: least-squares share of the differences (a - b) / (a + b) that is kept, their "
            "correlation, and light. Of the rest of the pixel, transistors and bars, nothing reaches a well.",
            charts=[svg(pictures.responses(s["curves"]))],
            head=("type", "differences, times", "correlation", "light, times"),
            rows=[
                (name, f"{one['kept']:.2f}", f"{one['correlation']:.2f}", f"{one['light']:.2f}")
                for name, one in s["response"].items()
            ],
        ),
        Section(
            "Lines",
            "A pixel's part, from the difference of two arrays; without gates and junctions.",
            head=("line", "ohm", *(f"fF, {corner}" for corner in CORNERS)),
            rows=[_line(name, line) for name, line in s["lines"].items()],
        ),
        Section(
            "Metal",
            f"Share of the tile, at most {100 * s['density_most']:.0f} %.",
            head=("metal", "share"),
            rows=[(name, f"{100 * share:.1f} %") for name, share in s["density"].items()],
        ),
        Section(
            "Drawn and solved",
            "On the manufacturing grid and under the process's rules; beta, m and quantum efficiency of the drawn "
            "gratings by the same solution as of the solved ones, which knows no pixel's edge and no fill factor.",
            head=("type", "lines along", "off, degrees", "period um", "fill", "analyzer", "beta", "m", "efficiency"),
            rows=[_row(one) for one in s["types"]],
        ),
    ]


def _broken(deck: str, name: str, rules: dict[str, int]) -> list[tuple[str, str, str, str]]:
    return [(deck, name, rule, str(count)) for rule, count in rules.items()] or [(deck, name, "all", "0")]


def _line(name: str, line: dict[str, Any]) -> tuple[str, ...]:
    return name, f"{line['ohm']:.2f}", *(f"{1e15 * line['farad'][corner]:.2f}" for corner in CORNERS)


def _row(one: dict[str, Any]) -> tuple[str, ...]:
    def pair(name: str, digits: int) -> str:
        return " : ".join(f"{value:.{digits}f}" for value in one[name])

    along = ", ".join(map(str, one["direction"]))
    places = {"period_um": 3, "fill": 3, "analyzer_fill": 3, "beta": 1, "m": 2, "quantum_efficiency": 3}
    return one["name"], along, f"{one['off_deg']:.2f}", *(pair(name, digits) for name, digits in places.items())
