"""The files of a light field: its page, pictures, a moving picture and the arrays."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL.Image import Image

from talbot.base import page
from talbot.base.page import Picture, Scale, Tile
from talbot.imaging.frame import pictures
from talbot.imaging.frame.light_field import SURE
from talbot.imaging.frame.merit import decibels
from talbot.imaging.frame.reading import agreement, line, number
from talbot.imaging.frame.report import Views
from talbot.imaging.lightfield.fields import Fields, depth_map
from talbot.models.reconstruct.refocus import refocus

Values = npt.NDArray[np.floating]
MOVING = "views.webp"
NAMES = ("lightfield.html", "summary.json", "lightfield.npz", MOVING)
FOCUSED = 4  # a side of the sheet of refocused pictures
FRAME_MS = 90  # of the moving picture


def write(folder: Path, fields: Fields) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    best = fields.best
    np.savez(folder / "lightfield.npz", light_field=best.light_field, disparity=best.disparity, spread=best.spread)
    top = pictures.brightest(fields.truth)
    _moving(folder / MOVING, best.light_field, top)
    shown = [("the scene", fields.truth)] + [(name, estimate.light_field) for name, estimate in fields.found.items()]
    groups = [("Depth", _depth(fields)), (f"Refocused, by the {fields.summary['best']}", _refocused(fields, top))]
    s, focus = fields.summary, _focus(fields)
    stack = [("the scene", fields.truth), (s["best"], fields.best.light_field)]
    text = page.render(
        Path(__file__).with_name("page.html"),
        f"{s['scene']}: the light field of a raw frame",
        picture=groups[1][1][0].image,
        about=line(s),
        tiles=headline(s),
        head=("", "PSNR", "gain", "SSIM", "slope", "correlation", "PSNR, float", "seconds", "once"),
        rows=table(s),
        views=[Views.of(caption, pictures.grays(field, top)) for caption, field in shown],
        stack=[Views.of(caption, _stack(field, focus, top)) for caption, field in stack],
        labels=[f"{d:+.2f}" for row in focus for d in row],
        groups=[group for group in groups if group[1]],
    )
    (folder / "lightfield.html").write_text(text, encoding="utf-8")


def headline(s: dict[str, Any]) -> list[Tile]:
    """Return the figures of the summary ``s`` to see first."""
    linear, best = s["methods"]["linear"], s["methods"][s["best"]]
    free, constant = decibels(s["baselines"]["sum_image_psnr_db"]), number(s["disparity_rms_constant_px"])
    return [
        Tile(decibels(best["psnr_db"]), f"{s['best']} (sum image copied: {free})"),
        Tile(decibels(linear["psnr_db"]), f"linear, {linear['seconds']:.2f} s a frame"),
        Tile(number(best["slope"]), f"slope of the parallax (linear {number(linear['slope'])})"),
        agreement(s),
        Tile(number(s["disparity_rms_px"]), f"px per view step, error of disparity RMS (one for all: {constant})"),
    ]


def table(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table: baselines, then methods. Worse than the copied image is said."""
    rows = []
    for name, key in (("sum image in every view", "sum_image_psnr_db"), ("gray", "gray_psnr_db")):
        rows.append((name, decibels(s["baselines"][key]), "", "", "0", "", "", "", ""))
    for name, m in s["methods"].items():
        note = "" if m["gain_db"] is None or m["gain_db"] > 0 else ": no better than the sum image"
        shape = (number(m[key]) for key in ("ssim", "slope", "correlation"))
        times = f"{m['seconds']:.2f}", f"{m['seconds_once']:.1f}"
        figures = decibels(m["psnr_db"]), decibels(m["gain_db"]), *shape, decibels(m["psnr_db_float"]), *times
        rows.append((name + note, *figures))
    return rows


def _depth(fields: Fields) -> list[Picture]:
    """True and found disparity, gray where it is not sure, and depth."""
    best, scene = fields.best, fields.result.exposed.scene
    disparity = np.where(best.spread <= SURE, best.disparity, np.nan)
    known = best.disparity if scene.disparity is None else np.asarray(scene.disparity, float)
    low, high = float(known.min()), float(known.max())
    low, high = low - 0.1, high + 0.1
    scale = Scale(pictures.depth_colours(), low, high, "px per view step")
    out = []
    if scene.disparity is not None:
        out.append(Picture("true", "", "disparity of the scene", pictures.depth(known, low, high), scale))
    s = fields.summary
    caption = f"disparity from the samples, gray where its standard deviation is above {SURE:g} px"
    if s["disparity_rms_px"] is not None:
        caption += f": {s['disparity_rms_px']:.2f} px RMS (one for all: {s['disparity_rms_constant_px']:.2f})"
    out.append(Picture("disparity", "", caption, pictures.depth(disparity, low, high), scale))
    if scene.depth is not None and s["depth_rms_m"] is not None:
        depth = np.where(np.isnan(disparity), np.nan, depth_map(fields.result, best))
        near, far = float(scene.depth.min()), float(scene.depth.max()) + 1e-3
        caption = f"depth: {100 * s['depth_rms_m']:.3g} cm RMS of {100 * s['range_m']:.3g} cm"
        caption += f" (one depth for all: {100 * s['depth_rms_constant_m']:.3g} cm)"
        scale = Scale(pictures.depth_colours(), near, far, "m")
        out.append(Picture("depth", "", caption, pictures.depth(depth, near, far), scale))
    return out


def _refocused(fields: Fields, top: float) -> list[Picture]:
    """Return the middle view, and pictures focused far, at the focal plane and near."""
    best = fields.best
    middle = len(best.light_field) // 2
    image = pictures.gray(best.light_field[middle, middle], high=top)
    out = [Picture("all", "", "all in focus: the middle view", image)]
    ends = np.quantile(best.disparity, (0.05, 0.5, 0.95))
    for name, disparity in zip(("far", "middle", "near"), ends, strict=True):
        image = refocus(best.light_field, float(disparity))
        caption = f"focused {name}: what has {disparity:+.2f} px a view step is sharp"
        out.append(Picture(name, "", caption, pictures.gray(image, high=top)))
    return out


def _focus(fields: Fields) -> list[list[float]]:
    """Disparities of the slider, from far to near, row by row and back as it takes them."""
    low, high = np.quantile(fields.best.disparity, (0.02, 0.98))
    return np.linspace(low, high, FOCUSED**2).reshape(FOCUSED, FOCUSED).tolist()


def _stack(field: Values, focus: list[list[float]], top: float) -> list[list[Image]]:
    """Return a light field focused on each disparity, every second row from right to left."""
    rows = [[pictures.gray(refocus(field, d), high=top) for d in row] for row in focus]
    return [row[::-1] if number % 2 else row for number, row in enumerate(rows)]


def _moving(path: Path, field: Values, top: float) -> None:
    """The outermost views one after the other, round the pupil, as an animated WebP."""
    last = len(field) - 1
    around = [(0, u) for u in range(last)] + [(v, last) for v in range(last)]
    around += [(last, u) for u in range(last, 0, -1)] + [(v, 0) for v in range(last, 0, -1)]
    first, *rest = (pictures.gray(field[v, u], high=top) for v, u in around or [(0, 0)])
    first.save(path, "WEBP", save_all=True, append_images=rest, duration=FRAME_MS, loop=0, quality=80)
