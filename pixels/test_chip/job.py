"""The test chip drawn, checked, read -> the shuttle's project, SPICE, picture, summary.json."""

import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any

from talbot.base.files import check_folder, staged
from talbot.base.gds import write_gds
from talbot.cells.corner import Corner
from talbot.pixels.post_layout.checks import differences
from talbot.pixels.test_chip import project
from talbot.pixels.test_chip.checks import PORTS, drc, lvs, netlist, untied
from talbot.pixels.test_chip.circuit import NAME
from talbot.pixels.test_chip.draw import HEIGHT, WIDTH, TestChip, draw_chip, relabelled
from talbot.pixels.test_chip.read import TYPICAL, Exposure, extracted, read
from talbot.platforms.analog import analog_masks

DESIGN = "tt_pixels"
STEPS = "draw", "drc", "lvs", "extract", "read", "report"
PICTURE = "tt_pixels.png"
TEXTS = {"info.yaml": project.info, "docs/info.md": project.page, f"{NAME}.lef": project.lef, f"{NAME}.v": project.stub}
# of an earlier run; folders are replaced whole
FILES = (
    *(name for name in TEXTS if "/" not in name),
    f"{NAME}.gds",
    f"{NAME}.spice",
    "drc.lyrdb",
    "lvs.lvsdb",
    PICTURE,
    "summary.json",
)


def make(pdk: str, out: Path, note: Callable[[str], None] = lambda text: None) -> dict[str, Any]:
    """Draw, check and simulate into ``out``; returns the summary. Raises ParameterError, StepError, ToolError."""
    from talbot.pixels.test_chip.picture import picture  # Matplotlib: not before it is needed

    start = perf_counter()
    check_folder("out", out)
    masks = analog_masks(pdk)
    with staged(out, FILES) as folder:
        note("draw")
        chip = draw_chip(masks)
        for name, text in TEXTS.items():
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_text(text(), encoding="utf-8")
        gds, circuit = folder / f"{NAME}.gds", netlist(chip, masks)
        write_gds(chip.layout, gds, chip.cell)
        (folder / f"{NAME}.spice").write_text(circuit, encoding="utf-8")
        note("drc")
        rules = drc(gds, masks, folder / "drc.lyrdb")
        note("lvs")
        named = folder / "named.gds"
        write_named(chip, named)
        same = lvs(named, circuit, masks, folder / "lvs.lvsdb")
        named.unlink()
        floating = untied(chip.layout, masks)
        note("extract")
        parasitics = extracted(chip, masks)
        note("read")
        exposure = Exposure()
        one = read(chip, parasitics, Corner.parse(TYPICAL), exposure)
        note("report")
        picture(gds, masks.base, folder / PICTURE)
        summary = {
            "process": pdk,
            "width_um": WIDTH,
            "height_um": HEIGHT,
            "transistors": len(chip.devices) + len(chip.pixels) * len(chip.array.pixels[0].circuit.transistors),
            "pixels": {f"{row},{col}": name for (row, col), name in chip.pixels.items()},
            "drc": rules,
            "lvs_match": same,
            "lvs_differs": [] if same else differences(folder / "lvs.lvsdb"),
            "untied": floating,
            "read": {"corner": TYPICAL, "exposure": asdict(exposure), **asdict(one), "gain": one.gain},
            "passed": same and not rules and not floating,
            "wall_s": perf_counter() - start,
        }
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return summary


def write_named(chip: TestChip, path: Path) -> None:
    """Write the layout with the names that LVS compares: outputs tied to ground share its name."""
    write_gds(relabelled(chip.layout, {port: port for port in PORTS}), path)


def line(summary: dict[str, Any], folder: Path) -> str:
    """Return the lines that the command prints."""
    one = summary["read"]
    return (
        f"{summary['width_um']:g} x {summary['height_um']:g} um, {summary['transistors']} transistors; design rules: "
        f"{sum(summary['drc'].values())} violations; LVS {'match' if summary['lvs_match'] else 'no match'}\n"
        f"read at {one['corner']}: {1e3 * (one['dark'][0] - one['end'][0]):.0f} and "
        f"{1e3 * (one['dark'][1] - one['end'][1]):.0f} mV at the pads, {one['gain'][0]:.3f} V for each V at the diode, "
        f"{one['milliwatt']:.2f} mW\n"
        f"{summary['wall_s']:.0f} s; the shuttle's project is {folder}"
    )
