"""The files of a sequence, which appear together at its end: streams, animation, figures of each frame, a page."""

import json
from collections.abc import Mapping
from dataclasses import replace
from os import times
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from talbot.base import page
from talbot.base.animation import Animation
from talbot.base.charts import curves, svg
from talbot.base.files import check_folder, staged
from talbot.base.page import Tile
from talbot.base.progress import Frames
from talbot.imaging.frame import pictures
from talbot.imaging.frame.figures import camera_line, camera_of, exposure_line, exposure_of
from talbot.imaging.frame.job import Clock
from talbot.imaging.frame.merit import decibels
from talbot.imaging.frame.report import agreement
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.frame.result import FrameResult, in_codes
from talbot.imaging.sequence.figures import of_all, of_frame
from talbot.imaging.sequence.job import results
from talbot.models.parameters import MODES, SIGNED, sensor_text
from talbot.models.scene import Clip

ANIMATIONS = {str(mode): "edges.webp" if mode in (*SIGNED, "raw") else "image.webp" for mode in MODES}
NAMES = ("stream.bin", "sensor.toml", "scene.png", "report.html", "summary.json", *ANIMATIONS.values())
SCALE = 64.0  # codes of full colour: the same in all frames
WIDTH = 384  # px of the animation at least
STRIP = 20  # px of the line of figures below it


def run(
    request: FrameRequest, clip: Clip, progress: Frames, arguments: Mapping[str, object] | None = None
) -> dict[str, Any]:
    """Simulate ``clip`` and write the files into ``request.folder``; returns summary.json.

    arguments: of the command line, kept in the summary. Raises ParameterError, ToolError, OSError.
    """
    check_folder("out", request.folder)
    clock, frames, last, shown, began = Clock(), [], None, None, None
    with staged(request.folder, NAMES) as folder:
        name = ANIMATIONS[request.frame.mode]
        with (folder / "stream.bin").open("wb") as stream, Animation(folder / name) as animation:
            for result, seconds in results(request, clip, clock, progress.note):
                began = began or times()
                with clock.step("figures"):
                    figures = of_frame(result)
                with clock.step("pictures"):
                    shown = picture(result, figures, f"{len(frames) + 1}/{clip.count or '-'}")
                    animation.add(shown, seconds)
                stream.write(result.stream)
                if last is None:
                    _first(folder, result)
                # The page needs the camera and what is read; of a frame's arrays no more is kept.
                last = result
                frames.append(figures)
                progress.step()
        if last is None or shown is None or began is None:
            raise AssertionError("no frame and no error")
        spent = np.subtract(times(), began)[:4].tolist()  # the simulator's are counted at its end: all frames
        summary = _about(request, clip, last) | of_all(frames, last, clock.seconds)
        summary |= {"processor_s": {"python": sum(spent[:2]), "simulator": sum(spent[2:])}}
        summary |= {"arguments": dict(arguments or {}), "each": frames}
        (folder / "report.html").write_text(_page(summary, name, shown), encoding="utf-8")
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return summary


def picture(result: FrameResult, figures: Mapping[str, Any], number: str) -> Image.Image:
    """Return a frame of the animation: what the chip sent, and its figures below."""
    samples, mode = result.decoded.samples, result.request.frame.mode
    if mode in SIGNED:
        image = pictures.signed_codes(in_codes(samples, result.request.frame)[..., 0], SCALE)
    elif mode == "raw":
        image = pictures.signed_codes(samples[..., 0] - samples[..., 1], SCALE)
    else:
        image = pictures.gray(result.image).convert("RGB")
    image = pictures.enlarge(image, WIDTH)
    out = Image.new("RGB", (image.width, image.height + STRIP), pictures.PAPER)
    out.paste(image)
    conversions, skipped = figures["conversions_made"], figures["conversions_left_out"]
    share = 100 * conversions / max(conversions + skipped, 1)
    text = f"{number}  {figures['stream_bytes']:,} bytes  {share:.1f} % converted  "
    text += f"SNR {decibels(figures['snr_db'])}"
    wrong = figures["stream_mismatches"] or figures["decoded_mismatches"]
    text += "  DIFFERS" if wrong else ""
    draw = ImageDraw.Draw(out)
    draw.text((4, image.height + 2), text, fill=pictures.INK, font=ImageFont.load_default(13))
    return out


def size_line(s: Mapping[str, Any]) -> str:
    """Bytes, SNR and energy of a frame on average."""
    low, high = s["energy_uj"]
    return (
        f"a frame: {s['stream_bytes'] / s['frames']:,.0f} bytes of {s['raw_bytes'] / s['frames']:,.0f} "
        f"({s['compression_ratio']:.2f}:1), SNR {decibels(s['snr_db_mean'])}, {1e3 * s['frame_s_at_clock']:.2f} ms at "
        f"the chip's clock, {low:.1f} to {high:.1f} uJ"
    )


def rate_line(s: Mapping[str, Any]) -> str:
    """Frames a second and where the time of a frame goes, in ms; the simulator's runs next to the rest."""
    parts = {name: 1e3 * s["wall_s"].get(name, 0.0) / s["frames"] for name in STEPS}
    text = ", ".join(f"{STEPS[name]} {ms:.1f}" for name, ms in parts.items())
    python = 1e3 * s["processor_s"]["python"] / max(s["frames"] - 1, 1)  # since the first was there
    simulator = 1e3 * s["processor_s"]["simulator"] / s["frames"]
    clock = f"{s['rtl_cycles_per_s'] / 1e6:.1f} M cycles/s"
    return (
        f"{s['frames_per_s']:.1f} frames/s once set up ({s['frames_per_s_in_all']:.1f} in all); ms a frame: {text}; "
        f"in parallel the simulator {1e3 * s['rtl_s'] / s['frames']:.1f}, {clock}; "
        f"processor time: Python {python:.1f}, simulator {simulator:.1f}"
    )


STEPS = {
    "read": "reading",
    "capture": "capture",
    "send": "sending",
    "golden": "golden model",
    "rtl": "waiting for the simulator",
} | {"decode": "decoding", "figures": "figures", "pictures": "pictures"}


def _first(folder: Path, result: FrameResult) -> None:
    (folder / "sensor.toml").write_text(sensor_text(result.request.sensor), encoding="utf-8")
    scene = pictures.gray(result.exposed.scene.image)
    pictures.enlarge(scene, WIDTH).save(folder / "scene.png")


def _about(request: FrameRequest, clip: Clip, last: FrameResult) -> dict[str, Any]:
    """Return a description of the run."""
    frame, sensor = request.frame, request.sensor
    camera = camera_of(replace(last, request=request))
    return (
        {"scene": clip.name, "mode": frame.mode, "rows": sensor.array.rows, "cols": sensor.array.cols}
        | {"threshold": frame.threshold, "lanes": sensor.chip.lanes, "noise": request.noise, "seed": request.seed}
        | {"window": vars(frame.window), "mask": f"{frame.mask:#08x}", "decimation": frame.decimation}
        | {"camera": camera, "exposure": exposure_of(last)}
    )


def _page(s: Mapping[str, Any], animation: str, last: Image.Image) -> str:
    """Return the page; last: picture of the last frame, for its card in the index."""
    frames = s["each"]
    tiles = [
        agreement(s["frames_that_differ"], "frames", f", {s['frames']} frames"),
        Tile(f"{s['compression_ratio']:.1f} : 1", f"{s['stream_bytes']:,} of {s['raw_bytes']:,} bytes"),
        Tile(decibels(s["snr_db_mean"]), "SNR of the decoded samples, mean (nothing sent: 0 dB)"),
        Tile(f"{s['frames_per_s']:.1f} /s", "frames simulated once set up"),
    ]
    size = [(i, frame["stream_bytes"], "") for i, frame in enumerate(frames)]
    noise = [(i, frame["snr_db"], "") for i, frame in enumerate(frames) if frame["snr_db"] is not None]
    drawn = [
        curves({"bytes": size}, "frame", "bytes", "Bytes of each frame"),
        curves({"SNR": noise}, "frame", "SNR (dB)", "SNR of each frame"),
    ]
    return page.render(
        Path(__file__).with_name("sequence.html"),
        f"{s['scene']}: {s['frames']} frames in {s['mode']} mode",
        picture=last,
        s=s,
        tiles=tiles,
        animation=animation,
        charts=[svg(chart) for chart in drawn],
        head=list(COLUMNS.values()),
        rows=[[_cell(frame[name]) for name in COLUMNS] for frame in frames],
        size=size_line(s),
        rate=rate_line(s),
        camera=camera_line(dict(s)),
        exposure=exposure_line(dict(s)),
    )


COLUMNS = {
    "frame_number": "frame",
    "stream_bytes": "bytes",
    "stream_mismatches": "bytes that differ",
    "conversions_made": "conversions",
    "conversions_left_out": "left out",
    "cycles": "cycles",
    "deviating_rows": "rows that integrate longer",
    "snr_db": "SNR (dB)",
    "energy_uj": "energy (uJ)",
    "views": "views",
}


def _cell(value: int | float | list[float] | None) -> str:
    if isinstance(value, list):
        return f"{value[0]:.1f} to {value[1]:.1f}"
    if isinstance(value, float):
        return f"{value:.1f}"
    return "-" if value is None else f"{value:,}"
