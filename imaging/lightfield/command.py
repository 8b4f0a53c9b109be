"""The light field and the depth of a scene from a raw frame of the chip, with baselines."""

from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from talbot.base.arguments import Number, real
from talbot.imaging.frame import reading

if TYPE_CHECKING:
    from talbot.imaging.frame.request import FrameRequest
    from talbot.imaging.frame.result import GoldenResult
    from talbot.models.reconstruct.bayes import FieldPrior

DISPARITIES = Number("disparities", "how many are tried; mixture tries those between, too", 1, 500, "21")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot lightfield`: texts, checked by `run`."""
    reading.add_arguments(parser, "lightfield", "motorcycle", {"mode": "raw"})
    add_prior_arguments(parser)
    words = "further methods, with commas, or all (imaging/lightfield/README.md); direct, linear and mixture always run"
    parser.add_argument("--method", default="", help=words)


def add_prior_arguments(parser: ArgumentParser) -> None:
    """Options of the disparities that are tried."""
    add = parser.add_argument
    words = "disparity that is tried, {}..20 px per step of the scene's views (default: {}12.5 over their number)"
    add("--far", help="farthest " + words.format(-20, "-"))
    add("--near", help="nearest " + words.format("far", ""))
    DISPARITIES.add(parser)


def prior_asked(options: Namespace, request: "FrameRequest") -> "Callable[[GoldenResult], FieldPrior]":
    """From the frame of ``request`` to its prior, of the disparities that the options name. Raises ParameterError."""
    from talbot.imaging.frame.light_field import prior_of, tried
    from talbot.models.scene import Sampling, load

    far = None if options.far is None else real("far", options.far, -20, 20)
    near = None if options.near is None else real("near", options.near, -20 if far is None else far, 20)
    disparities = DISPARITIES.value(options)
    if (near is None) != (far is None):  # the other is the scene's
        tried(load(request.scene, Sampling.of(request.sensor), request.depth).views, near, far)
    return partial(prior_of, far=far, near=near, disparities=disparities)


def run(options: Namespace) -> int:
    """Read one frame back and print the figures; 1 where the chip and the golden model differ."""
    from talbot.imaging.lightfield.fields import Fields, methods_of, read_back

    methods = methods_of(options.method)
    from talbot.imaging.lightfield import page  # Matplotlib: not before it is needed

    frame_request, typed = reading.asked(options, "lightfield", add_arguments)
    prior = prior_asked(options, frame_request)

    def found(note: reading.Note) -> Fields:
        result = reading.frame_of(frame_request, note, options.golden)
        return read_back(result, prior(result), note, methods)

    steps = "setup", "capture", "build", "rtl", "decode", *methods, "report"
    return reading.run(frame_request, typed, steps, found, page, _print)


def _print(s: dict[str, Any], folder: Path) -> None:
    from talbot.imaging.lightfield.page import table

    print(f"{s['scene']}: {s['views']} x {s['views']} views of {s['rows']} x {s['cols']} pixels from a raw frame")
    for name, psnr, gain, _, slope, *_, seconds, once in table(s):
        rest = f"  gain {gain:>8}  slope {slope}  {seconds} s (once {once} s)" if gain else ""
        print(f"  {name:<42}{psnr:>8}{rest}")
    for name, psnr in s.get("true_optics", {}).items():
        print(f"  {f'{name}, with the true optics':<42}{reading.number(psnr)} dB")
    error, constant = reading.number(s["disparity_rms_px"]), reading.number(s["disparity_rms_constant_px"])
    print(f"  disparity {error} px RMS where it is sure ({100 * s['depth_sure']:.0f} %); one for all: {constant} px")
    if s["depth_rms_m"] is not None:
        constant = f"{s['depth_rms_constant_m']:.4f} m"
        print(f"  depth {s['depth_rms_m']:.4f} m RMS of {s['range_m']:.4f} m; one for all: {constant}")
    print(f"  look at {folder / 'lightfield.html'}")
