"""The light field and the depth of a scene from a raw frame of the chip, every method beside the free baselines."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.progress import Steps
from talbot.flow.frame import arguments as text
from talbot.flow.frame.sensor import add_pixel, asked_sensor
from talbot.pixels.designs import IDEAL

QUIET = 0.5  # of the default noise: what rounding to codes leaves without any other


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot lightfield`: texts, checked by `run`."""
    add = parser.add_argument
    add("--scene", default="motorcycle", help="name of a scene, an image, or a light field, as for talbot sim")
    add("--depth", help="depth file for --scene (models/scene/README.md)")
    add("--sensor", help="sensor file; talbot sensor prints one to start from")
    add_pixel(parser)
    add("--rows", help="pixels, 1..1024 (default: of the sensor)")
    add("--cols", help="pixels, 1..1536 (default: of the sensor)")
    add("--noise", default="1.0", help="times the physical noise, 0..100")
    add("--seed", default="1", help="of every random draw, 0..4294967295")
    add("--far", default="-2.5", help="farthest disparity that is tried, -20..20 px per view step")
    add("--near", default="2.5", help="nearest disparity that is tried, far..20 px per view step")
    add("--disparities", default="21", help="how many are tried, 1..500")
    add("--golden", action="store_true", help="by the golden chip alone, without its Verilog")
    add("--out", help="folder for the results (default: build/lightfield/<scene>)")


def run(options: Namespace) -> int:
    """Read one frame back and print the figures; 1 where the chip and the golden model differ."""
    from talbot.flow.frame.request import request
    from talbot.models.reconstruct.bayes import FieldPrior

    from .job import STEPS, run

    suffix = "" if options.pixel == IDEAL else f"-pixel={options.pixel}"
    numbers: dict[str, Any] = {}
    for name, high in (("rows", 1024), ("cols", 1536)):
        if getattr(options, name) is not None:
            numbers[name] = text.integer(name, getattr(options, name), 1, high)
    far = text.real("far", options.far, -20, 20)
    noise = text.real("noise", options.noise, 0, 100)
    prior = FieldPrior(
        noise=FieldPrior.noise * max(noise, QUIET),
        far=far,
        near=text.real("near", options.near, far, 20),
        disparities=text.integer("disparities", options.disparities, 1, 500),
    )
    asked = request(
        scene=options.scene,
        depth=options.depth,
        sensor=asked_sensor(options),
        converter=None if options.sensor else "typical",
        mode="raw",
        noise=noise,
        seed=text.integer("seed", options.seed, 0, 2**32 - 1),
        out=options.out or Path("build/lightfield") / (Path(options.scene).stem + suffix),
        **numbers,
    )
    with Steps(STEPS, lines=True) as steps:
        summary = run(asked, prior, steps.note, options.golden)
    _print(summary, asked.folder)
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
