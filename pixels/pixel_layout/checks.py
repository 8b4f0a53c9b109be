"""Design rules and layout against circuit of drawn pixels, by the decks that PDKMaster exports for the process."""

from pathlib import Path

from talbot.base.cache import cached, digest
from talbot.base.gds import db, read_gds
from talbot.base.paths import BUILD
from talbot.base.sources import code
from talbot.base.steps import StepError
from talbot.platforms.decks import export_decks
from talbot.platforms.layout import layout_platform
from talbot.platforms.pixel import PixelProcess, pixel_process
from talbot.signoff.geometry.decks import broken_rules, hole_rules, is_circuit, via_rules

STORE = BUILD / "pixel" / "decks"
# Rules that pixels break on purpose: what they ask, and why they are waived
WAIVERS = {
    "x.2": "Edges at a multiple of 45 degrees. Types of beta 18 modulate at 22.5 and 67.5 degrees: their lines are "
    "exact rectangles along (12, 5) of the grid, in the gratings' metals alone. A mask shop that takes no such angle "
    "would have them as steps of the grid."
}


def common_decks(pdk: str) -> tuple[list[str], str]:
    """Checks of all drawn cells: the rules as pieces of a deck, and PDKMaster's deck of LVS."""
    tech = layout_platform(pdk)

    def make(folder: Path) -> None:
        for name, text in export_decks(tech).items():
            (folder / name).write_text(text, encoding="utf-8")

    kept = cached(STORE / digest(code("talbot.platforms.decks"), pdk), make)
    masks = [tech.masks.read_text(encoding="utf-8")] if tech.masks else []
    rules, lvs = ((kept / name).read_text(encoding="utf-8") for name in ("drc", "lvs"))
    return [rules, *hole_rules(tech), *via_rules(tech), *masks], lvs


def decks(pdk: str) -> tuple[str, str]:
    """Return the decks of design rules and of LVS, text, with what pixels need beyond PDKMaster's."""
    process, (rules, lvs) = pixel_process(pdk), common_decks(pdk)
    return "\n".join([*rules, process.masks.read_text(encoding="utf-8"), ""]), with_diodes(lvs, process)


def with_diodes(lvs: str, process: PixelProcess) -> str:
    """Return a deck of LVS that extracts the pixels' photodiodes, too. Raises StepError."""
    mark = "\nnetlist\n"
    if lvs.count(mark) != 1:
        raise StepError("lvs: the deck has no single line 'netlist' before which diodes could be extracted")
    return lvs.replace(mark, f"\n{process.lvs.read_text(encoding='utf-8')}{mark}")


def drc(gds: Path, pdk: str, report: Path) -> dict[str, int]:
    """Violations by rule, waived ones among them. report: KLayout's report database. Raises StepError."""
    return broken_rules({report.with_suffix(".drc"): decks(pdk)[0]}, gds, report)


def unwaived(found: dict[str, int]) -> int:
    """Violations of rules that are not waived."""
    return sum(count for rule, count in found.items() if rule not in WAIVERS)


def lvs(gds: Path, spice: str, pdk: str, report: Path) -> bool:
    """Return whether the top cell of ``gds`` is the circuit that the text ``spice`` has last. Raises StepError."""
    return is_circuit(decks(pdk)[1], gds, spice, report)


def densities(gds: Path, pdk: str) -> dict[str, float]:
    """Share of the top cell's outline that each metal covers, by its LEF name."""
    process, layout = pixel_process(pdk), read_gds(gds)
    top = layout.top_cell()
    box = db.Region(top.begin_shapes_rec(layout.layer(*process.outline))).bbox()

    def covered(metal: tuple[int, int]) -> float:
        shapes = db.Region(top.begin_shapes_rec(layout.layer(*metal))) & db.Region(box)
        return shapes.merged().area() / box.area()

    return {metal.lef: covered(metal.gds) for metal in process.metals}


def placed(gds: Path) -> "dict[tuple[int, int], str]":
    """Names of the cells below the top one of a file, by the corner of each instance in nm, arrays expanded."""
    layout = read_gds(gds)
    out = {}
    for instance in layout.top_cell().each_inst():
        name, a, b = instance.cell.name, instance.a, instance.b
        x, y = instance.trans.disp.x, instance.trans.disp.y
        for i in range(max(1, instance.na)):
            for k in range(max(1, instance.nb)):
                if name.startswith("pixel"):
                    out[x + i * a.x + k * b.x, y + i * a.y + k * b.y] = name
    return out
