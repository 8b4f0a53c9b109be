"""A sequence of pictures through one running simulation of the chip: edges as an animation, figures of each frame."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.paths import results_of
from talbot.imaging.frame.command import add_frame_arguments, arguments_of, name_of, request_of, tell_replaced, typed_of
from talbot.imaging.simulate.frame import WAVES

FIXED = {"depth": None, "waves": None, "waves_format": WAVES[0]}


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot sequence`: texts, checked by `run`."""
    parser.add_argument(
        "--scene",
        required=True,
        help="a folder of frames, an animated GIF, WebP, PNG or AVIF, or a video (models/scene/README.md)",
    )
    add_frame_arguments(parser, FIXED)
    parser.add_argument("--out", help="folder for the results (default: build/sequence/<scene>, named as by sim)")


def run(options: Namespace) -> int:
    """Simulate the sequence and print its figures; 1 where the chip and the golden model differ."""
    from talbot.base.progress import Frames
    from talbot.models.scene import Sampling, open_clip

    typed = typed_of(options, _with_scene)
    options.out = options.out or results_of("sequence") / name_of(typed)
    frame_request = request_of(options, sequence=True)
    clip, before = open_clip(options.scene, Sampling.of(frame_request.sensor)), arguments_of(frame_request.folder)
    from talbot.imaging.sequence.outputs import run  # Matplotlib and more: not before the arguments are right

    with Frames(clip.count) as progress:
        summary = run(frame_request, clip, progress, typed)
    _print_figures(summary, frame_request.folder)
    tell_replaced(before, typed)
    return 1 if summary["frames_that_differ"] else 0


def _with_scene(parser: ArgumentParser) -> None:
    """Return the typed options with defaults for the others."""
    parser.add_argument("--scene")
    add_frame_arguments(parser, FIXED)


def _print_figures(s: dict[str, Any], folder: Path) -> None:
    from talbot.imaging.frame.figures import exposure_line
    from talbot.imaging.sequence.outputs import rate_line, size_line

    print(
        f"{s['scene']}, {s['mode']} mode, {s['rows']} x {s['cols']}, {s['frames']} frames: "
        f"{s['frames_that_differ']} differ from the model"
    )
    print(f"  {exposure_line(s)}")
    print(f"  {size_line(s)}")
    print(f"  {rate_line(s)}")
    print(f"  look at {folder / 'report.html'}")
