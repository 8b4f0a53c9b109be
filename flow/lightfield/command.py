"""The light field and the depth of a scene from a raw frame of the chip, every method beside the free baselines."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from talbot.base.progress import Steps
from talbot.flow.frame import arguments as text
from talbot.flow.frame import reading

if TYPE_CHECKING:
    from talbot.models.reconstruct.bayes import FieldPrior

QUIET = 0.5  # of the default noise: what rounding to codes leaves without any other


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot lightfield`: texts, checked by `run`."""
    reading.add_arguments(parser, "lightfield", "motorcycle")
    add_prior_arguments(parser)


def add_prior_arguments(parser: ArgumentParser) -> None:
    """Options of the disparities that are tried."""
    add = parser.add_argument
    add("--far", default="-2.5", help="farthest disparity that is tried, -20..20 px per view step")
    add("--near", default="2.5", help="nearest disparity that is tried, far..20 px per view step")
    add("--disparities", default="21", help="how many are tried, 1..500")


def prior_of(options: Namespace) -> "FieldPrior":
    """The prior of `add_prior_arguments` and the noise. Raises ParameterError."""
    from talbot.models.reconstruct.bayes import FieldPrior

    far = text.real("far", options.far, -20, 20)
    return FieldPrior(
        noise=FieldPrior.noise * max(text.real("noise", options.noise, 0, 100), QUIET),
        far=far,
        near=text.real("near", options.near, far, 20),
        disparities=text.integer("disparities", options.disparities, 1, 500),
    )


def run(options: Namespace) -> int:
    """Read one frame back and print the figures; 1 where the chip and the golden model differ."""
    from .job import STEPS, run

    prior, asked = prior_of(options), reading.asked(options, "lightfield", "raw")
    with Steps(STEPS, lines=True) as steps:
        summary = run(asked, prior, steps.note, options.golden)
    _print(summary, asked.folder)
    return int(reading.differs(summary))


def _print(s: dict[str, Any], folder: Path) -> None:
    from .page import table

    print(f"{s['scene']}: {s['views']} x {s['views']} views of {s['rows']} x {s['cols']} pixels from a raw frame")
    for name, psnr, gain, _, slope, *_, seconds, once in table(s):
        rest = f"  gain {gain:>8}  slope {slope}  {seconds} s (once {once} s)" if gain else ""
        print(f"  {name:<42}{psnr:>8}{rest}")
    error, constant = reading.number(s["disparity_rms_px"]), reading.number(s["disparity_rms_constant_px"])
    print(f"  disparity {error} px RMS where it is sure ({100 * s['depth_sure']:.0f} %); one for all: {constant} px")
    if s["depth_rms_m"] is not None:
        constant = f"{s['depth_rms_constant_m']:.4f} m"
        print(f"  depth {s['depth_rms_m']:.4f} m RMS of {s['range_m']:.4f} m; one for all: {constant}")
    print(f"  look at {folder / 'lightfield.html'}")
