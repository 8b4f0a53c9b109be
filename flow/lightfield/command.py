"""The light field and the depth of a scene from a raw frame of the chip, every method beside the free baselines."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.progress import Steps
from talbot.flow.frame import arguments as text
from talbot.flow.frame.command import add_frame_arguments, arguments_of, name_of, request_of, tell_replaced, typed_of
from talbot.flow.simulate.frame import WAVES

# A light field is read back from all of a raw frame
FIXED = {"mode": "raw", "threshold": "0", "phase": False, "types": "all", "window": "full", "decimation": "0"}
FIXED |= {"waves": None, "waves_format": WAVES[0]}


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot lightfield`: texts, checked by `run`."""
    add = parser.add_argument
    add("--scene", default="motorcycle", help="name of a scene, an image, or a light field, as for talbot sim")
    add("--depth", help="depth file for --scene (models/scene/README.md)")
    add_frame_arguments(parser, FIXED)
    add("--far", default="-2.5", help="farthest disparity that is tried, -20..20 px per view step")
    add("--near", default="2.5", help="nearest disparity that is tried, far..20 px per view step")
    add("--disparities", default="21", help="how many are tried, 1..500")
    add("--golden", action="store_true", help="by the golden chip alone, without its Verilog")
    add("--out", help="folder for the results (default: build/lightfield/<scene>, as of sim)")


def run(options: Namespace) -> int:
    """Read one frame back and print the figures; 1 where the chip and the golden model differ."""
    from .fields import prior_of
    from .job import STEPS, run

    typed = typed_of(options, add_arguments)
    options.out = options.out or Path("build/lightfield") / name_of(typed)
    far = text.real("far", options.far, -20, 20)
    near = text.real("near", options.near, far, 20)
    count = text.integer("disparities", options.disparities, 1, 500)
    asked = request_of(options)
    prior = prior_of(asked.noise, far=far, near=near, disparities=count)
    before = arguments_of(asked.folder)
    with Steps(STEPS, lines=True) as steps:
        summary = run(asked, prior, steps.note, options.golden, typed)
    _print(summary, asked.folder)
    tell_replaced(before, typed)
    return 1 if summary["stream_mismatches"] or summary["decoded_mismatches"] else 0


def _print(s: dict[str, Any], folder: Path) -> None:
    from .page import number, table

    print(f"{s['scene']}: {s['views']} x {s['views']} views of {s['rows']} x {s['cols']} pixels from a raw frame")
    for name, psnr, gain, _, slope, *_, seconds, once in table(s):
        rest = f"  gain {gain:>8}  slope {slope}  {seconds} s (once {once} s)" if gain else ""
        print(f"  {name:<42}{psnr:>8}{rest}")
    error, constant = number(s["disparity_rms_px"]), number(s["disparity_rms_constant_px"])
    print(f"  disparity {error} px RMS where it is sure ({100 * s['depth_sure']:.0f} %); one for all: {constant} px")
    if s["depth_rms_m"] is not None:
        constant = f"{s['depth_rms_constant_m']:.4f} m"
        print(f"  depth {s['depth_rms_m']:.4f} m RMS of {s['range_m']:.4f} m; one for all: {constant}")
    print(f"  look at {folder / 'lightfield.html'}")
