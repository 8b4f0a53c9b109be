"""The pixel drawn in a process's masks: 24 types, tile, array with dummies and guard rings, checked."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.progress import Steps
from talbot.base.sensor import add_sensor, labelled, sensor_asked
from talbot.pixels.drawn import ARRAY_FIELDS, DRAWN_ARRAY

VARIED = DRAWN_ARRAY


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot pixel-layout`. The foundry's decks are those of PDK_ROOT."""
    parser.add_argument("--pdk", default="sky130", help="process, sky130")
    add_sensor(parser, ARRAY_FIELDS)
    parser.add_argument(
        "--table", type=Path, help="also write the lines for models: models/parameters/pixel_lines.json"
    )
    parser.add_argument(
        "--curves", type=Path, help="also write the drawn types' responses: models/parameters/pixel_curves.json"
    )
    parser.add_argument(
        "--heights", help="which published table of heights the responses have, where there are several"
    )
    parser.add_argument("--out", type=Path, help="folder for the results (default: build/pixel-layout/<pdk>)")


def run(options: Namespace) -> int:
    """Draw, check, write the page and print the figures; 1 where a check fails."""
    from talbot.base.paths import RESULTS

    sensor = sensor_asked(options, VARIED, ARRAY_FIELDS)
    from talbot.pixels.pixel_layout.job import STEPS, make

    name = labelled(options.pdk, options) + (f"-{options.heights}" if options.heights else "")
    out = options.out or RESULTS / "pixel-layout" / name
    with Steps(STEPS, lines=True) as steps:
        summary = make(options.pdk, sensor, out, options.table, options.curves, options.heights, steps.note)
    _print(summary, out)
    return 0 if summary["passed"] else 1


def _print(s: dict[str, Any], folder: Path) -> None:
    from talbot.pixels.pixel_layout.page import waivers

    print(f"{s['process']}: {s['rows']} x {s['cols']} pixels, {s['width_um']:g} x {s['height_um']:g} um")
    print(f"  GDS of {s['gds_bytes'] / 1e6:.2f} MB in {s['gds_s']:.1f} s; {s['misplaced']} pixels not of their type")
    print(f"  DRC: {s['drc_violations']} violations{f', {waivers(s)}' if waivers(s) else ''}")
    for deck, files in s["foundry"].items():
        counts = (f"{sum(rules.values())} in {name}" for name, rules in files.items())
        print(f"  the foundry's rules, {deck}: {', '.join(counts)}")
    if not s["foundry"]:
        print("  the foundry's rules: not run; PDK_ROOT has no installed PDK")
    for name, same in s["lvs_match"].items():
        print(f"  LVS of {name}: {'matches' if same else 'DIFFERS'}")
    dense = max(s["density"], key=lambda name: s["density"][name])
    print(f"  fill factor {s['fill_factor']:.3f}; densest metal {dense}, {100 * s['density'][dense]:.0f} % of the tile")
    for name, one in s["response"].items():
        print(
            f"  {name}: the drawn pixel keeps {one['kept']:.2f} of the endless gratings' differences and "
            f"{one['light']:.2f} of their light; correlation {one['correlation']:.2f}"
        )
    for name, line in s["lines"].items():
        print(f"  {name}: {line['ohm']:.2f} ohm, {1e15 * line['farad']['typ']:.2f} fF a pixel")
    print(f"  {s['wall_s']:.0f} s; look at {folder / 'pixel_layout.html'}")
