"""The pixel of a process: gratings of its metals that make the tile's types, what they do to light, and how well."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.progress import Steps
from talbot.models.parameters import check_choice


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot pixel`: texts, checked by `run`."""
    parser.add_argument("--pdk", default="sky130", help="process, sky130 or ihp-sg13g2")
    parser.add_argument("--heights", help="which published table of heights, where the process has several")
    parser.add_argument("--kind", default="all", help="amplitude, interleaved, photogate, or all: the best one")
    parser.add_argument("--out", type=Path, help="folder for the results (default: build/pixel/<pdk>)")


def run(options: Namespace) -> int:
    """Search, write the page and print the figures; 1 where no beta of the tile can be made."""
    from talbot.base.paths import RESULTS
    from talbot.pixels.optics.geometry import KINDS
    from talbot.platforms.optics import optical_stack

    from .job import STEPS, make
    from .search import offered

    check_choice("kind", options.kind, (*KINDS, "all"))
    stack = optical_stack(options.pdk, options.heights)
    kinds = offered(stack, KINDS if options.kind == "all" else (options.kind,))
    out = options.out or RESULTS / "pixel" / options.pdk
    with Steps(STEPS, lines=True) as steps:
        summary = make(stack, kinds, out, steps.note)
    _print(summary, out)
    return 0 if any(row["reached"] for row in summary["betas"]) else 1


def _print(s: dict[str, Any], folder: Path) -> None:
    print(f"{s['process']}: {s['kind']} pixel at {1e3 * s['wavelength_um']:.0f} nm, {s['tried']} gratings tried")
    for row in s["betas"]:
        metals = row["diffraction"] + (f" over {row['analyzer']}" if row["analyzer"] else "")
        said = "" if row["reached"] else ": not reached, the nearest is"
        print(
            f"  beta {row['wanted']:g}{said} {row['beta']:.1f}: {metals}, period {row['period_um']:g} um; "
            f"m {row['m']:.2f}, quantum efficiency {row['quantum_efficiency']:.3f}, "
            f"extinction ratio {row['extinction_ratio']:.2f}, residual of Eq. 3.1 {row['residual_rms']:.2f} rms"
        )
    print(f"  {s['wall_s']:.0f} s; look at {folder / 'pixel.html'}")
