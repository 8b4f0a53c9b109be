"""Polarization of a scene from a raw frame of the chip, and its highlights, with baselines."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.arguments import Number
from talbot.imaging.frame import reading
from talbot.imaging.frame.reading import number

STEPS = ("setup", "capture", "build", "rtl", "decode", "polarization", "disparity", "report")
HIGHLIGHT = Number(
    "highlight", "polarized light above which a pixel is a highlight, of white", 0, 16, "0.1", kind=float
)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot polar`: texts, checked by `run`."""
    reading.add_arguments(parser, "polar", "specular", {"mode": "raw"})
    HIGHLIGHT.add(parser)


def run(options: Namespace) -> int:
    """Read one frame and print the figures; 1 where the chip and the golden model differ."""
    from talbot.imaging.polar import page  # Matplotlib: not before it is needed
    from talbot.imaging.polar.measure import PolarFrame, read_polarization

    highlight = HIGHLIGHT.value(options)
    frame_request, typed = reading.asked(options, "polar", add_arguments)

    def found(note: reading.Note) -> PolarFrame:
        return read_polarization(reading.frame_of(frame_request, note, options.golden), highlight, note)

    return reading.run(frame_request, typed, STEPS, found, page, _print)


def _print(s: dict[str, Any], folder: Path) -> None:
    print(f"{s['scene']}: polarization of {s['rows']} x {s['cols']} pixels, seen in {100 * s['sure']:.1f} %")
    error, free = number(s["psi_error_deg"], 2, " degrees"), number(s["baselines"]["psi_error_constant_deg"], 2)
    print(
        f"  psi off by {error} on average (demosaiced alone {number(s['psi_error_demosaiced_deg'])}, constant {free})"
    )
    print(f"  degree off by {number(s['degree_rms'], 3)} RMS (none: {number(s['baselines']['degree_rms_none'], 3)})")
    if s["f1"] is not None:
        print(f"  highlights: F1 {s['f1']:.3f} (brightest pixels: {number(s['baselines']['f1_bright'], 3)})")
    if s["disparity"] is not None:
        off = {name: number(value, 2) for name, value in s["disparity"].items()}
        print(
            f"  disparity in the highlights off by {off['untagged_rms_px']} px RMS without them (as found "
            f"{off['found_rms_px']}, brightest pixels left out {off['unbright_rms_px']}, one for all "
            f"{off['constant_rms_px']})"
        )
    print(f"  {s['full_tagged']} of {s['full']} full pixels that are no highlight tagged")
    print(f"  look at {folder / 'polar.html'}")
