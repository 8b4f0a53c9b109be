"""The files of a run: page, arrays, and the table of a document."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from markupsafe import Markup
from PIL import Image

from talbot.base.charts import curves as chart
from talbot.base.charts import svg
from talbot.base.page import TABLES, Picture, Section, Tile, render
from talbot.base.table import markdown_table
from talbot.imaging.frame import report
from talbot.imaging.recognize import study
from talbot.imaging.recognize.chip import CHUNK
from talbot.imaging.recognize.gestures import FRAMES, MOVES
from talbot.imaging.recognize.intensity import ACTIVE
from talbot.imaging.recognize.job import Recognition
from talbot.imaging.recognize.pose import PITCH, YAW

NAMES = ("recognize.html", "summary.json", "features.npz")
TEXTS = {
    "asp": "ASP codes, {types} types of alpha 0, threshold {threshold}",
    "whole": "image mode of the same array, in focus",
    "ternary": "ASP ternary: sign, or 0 below the threshold",
    "gradient": "binary gradient (Eq. A.1), as published",
    "image": "plain image of the picture's size, in focus",
    "same_bytes": "plain image in at most as many bytes",
    "random": "random 12 filters on the plain image",
    "shipped": "ASP codes, LeNet with shipped weights",
    "learned": "learned 12 filters on the plain image",
    "chance": "chance: the most frequent class",
}
HEAD = ("", "accuracy", "spread of seeds", "bytes", "sensor, uJ", "network, uJ")
AXES = {
    "threshold": ("threshold, codes", "Accuracy over the threshold"),
    "bits": ("bits", "Accuracy over the bits of codes and gradient"),
    "snr": ("SNR of the pictures, dB", "Accuracy over white noise in the pictures (Fig. 6.6)"),
    "blur": ("blur, picture px", "Accuracy over the blur: the picture's depth"),
    "draws": ("draw", "Error of random filters (Sec. 6.4.4)"),
}
SHOWN = 6  # pictures
Array = npt.NDArray[Any]


def rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table of the summary ``s``: fronts, then baselines."""
    return [(_text(name, s), *_cells(row)) for name, row in s["rows"].items()]


def _text(name: str, s: dict[str, Any]) -> str:
    front, _, threshold = name.partition("_") if name not in TEXTS else (name, "", "")
    return TEXTS[front].format(types=s["types"], threshold=threshold or s["threshold"])


def _cells(row: dict[str, Any]) -> tuple[str, ...]:
    return f"{100 * row['accuracy']:.2f} %", _percent(row["accuracy_std"]), *_cost(row), f"{row['network_uj']:.3g}"


def _percent(spread: float | None) -> str:
    return "-" if spread is None else f"{100 * spread:.2f}"


def _cost(row: dict[str, Any]) -> tuple[str, str]:
    low, high = row["energy_uj"]
    energy = "-" if not high else f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}"
    return f"{row['bytes']:.0f}" if row["bytes"] else "-", energy


def gesture_rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table of gestures."""
    return [(name, *_cells(row)) for name, row in s["gestures"].items()]


def intensity_rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table of recovered intensity: the collection, the method, and its figures."""
    return [
        (name, method, *_quality(row), *_cost(row))
        for name, by_method in s["intensity"].items()
        for method, row in by_method.items()
    ]


def intensity_table(s: dict[str, Any]) -> str:
    """Return the PSNR in dB and the SSIM of every method (row) and collection (column) as Markdown."""
    collections = s["intensity"]
    rows: dict[str, list[str]] = {}
    for by_method in collections.values():
        for method, row in by_method.items():
            psnr, _, ssim, _ = _quality(row)
            rows.setdefault(method, []).append("-" if psnr == "-" else f"{psnr} ({ssim})")
    return markdown_table(("", *collections), [(method, *cells) for method, cells in rows.items()], 1)


def gesture_table(s: dict[str, Any]) -> str:
    """Return the table of gestures as Markdown."""
    return markdown_table(HEAD, gesture_rows(s), 1)


def pose_rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table of head poses."""
    return [
        (name, *_written(row, dict.fromkeys(POSE_KEYS, 2)), *_cost(row), f"{row['network_uj']:.3g}")
        for name, row in s["pose"].items()
    ]


def pose_table(s: dict[str, Any]) -> str:
    """Return the table of head poses as Markdown."""
    return markdown_table(POSE_HEAD, pose_rows(s), 1)


def _quality(row: dict[str, Any]) -> tuple[str, ...]:
    return _written(row, {"psnr_db": 2, "psnr_db_std": 2, "ssim": 3, "ssim_std": 3})


def _written(row: dict[str, Any], places: dict[str, int]) -> tuple[str, ...]:
    return tuple("-" if row[key] is None else f"{row[key]:.{n}f}" for key, n in places.items())


INTENSITY_HEAD = ("", "from", "PSNR, dB", "spread of seeds", "SSIM", "spread of seeds", "bytes", "sensor, uJ")
POSE_KEYS = ("error_deg", "error_deg_std", "yaw_deg", "pitch_deg")
POSE_HEAD = ("", "mean error, deg", "spread of seeds", "yaw", "pitch", *HEAD[3:])
TABLES_OF = {"gestures": gesture_table, "intensity": intensity_table, "pose": pose_table}  # of a document, by curve


def lines(s: dict[str, Any]) -> str:
    """Return the table as Markdown, without other thresholds, and without ``same_bytes`` where it is ``image``."""
    chosen = {name: row for name, row in s["rows"].items() if name in TEXTS}
    same, image = (chosen.get(name, {}) | {"train_s": 0} for name in ("same_bytes", "image"))
    if same == image:
        chosen.pop("same_bytes", None)
    return markdown_table(HEAD, rows(s | {"rows": chosen}), 1)


def about(s: dict[str, Any]) -> str:
    """Return the text below a page's title."""
    height, width = s["size"]
    return (
        f"{s['pictures']:,} pictures of {height} x {width} px in {s['classes']} classes, {s['trained_on']:,} to train, "
        f"{s['tested_on']:,} to test; {s['scale']} sensor px a picture px, blur of {s['blur']:g} picture px, threshold "
        f"{s['threshold']}, noise {s['noise']:g}, {s['seeds']} seeds, classifier {s['classifier']}"
    )


def write(folder: Path, result: Recognition) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    s, data, base = result.summary, result.study.data, result.study.base
    some = study.see(replace(base, front=result.study.fronts[0]), data.radiance[:CHUNK])
    np.savez_compressed(
        folder / "features.npz", features=some.channels.astype(np.float16), labels=data.labels[: len(some.channels)]
    )
    shown = _pictures(result, some.channels)
    text = render(
        TABLES,
        f"{data.name}: recognition on what the sensor sends",
        picture=shown[1].image,
        about=about(s),
        tiles=_headline(s),
        sections=[
            Section("Every front, with baselines", NOTE, head=HEAD, rows=rows(s)),
            Section("Pictures, and what is sent of them", pictures=shown),
            *_curves(result),
            *_alarms(result),
            *_gestures(result),
            *_intensity(result),
            *_pose(result),
        ],
    )
    (folder / "recognize.html").write_text(text, encoding="utf-8")


NOTE = (
    "Accuracy: mean over seeds, each with its own split and draws; spread: standard deviation, in percent points. "
    "Sensor: the lower and the higher reading of the energy model. Network: 0.23 pJ for each multiply-accumulate, "
    "without memory."
)


def _headline(s: dict[str, Any]) -> list[Tile]:
    free, same = s["baselines"], s["rows"]["same_bytes"]
    check = report.agreement(s["stream_mismatches"]) if s["verilog"] else Tile("not run", "the chip's Verilog", "none")
    return [
        Tile(
            f"{100 * s['accuracy']:.2f} %",
            f"accuracy, spread {_percent(s['accuracy_std'])} (chance: {100 * free['chance']['accuracy']:.1f} %)",
        ),
        Tile(f"{100 * same['accuracy']:.2f} %", "of a plain image in at most as many bytes"),
        Tile(f"{s['bytes']:.0f}", "bytes a frame"),
        check,
    ]


def _pictures(result: Recognition, channels: Array) -> list[Picture]:
    """Some pictures, and their first channel."""
    first = channels[:SHOWN, :, :, 0].astype(float)
    gray = np.round(127.5 + 127.5 * first / max(float(np.abs(first).max()), 1e-9)).astype(np.uint8)
    named = (
        ("pictures", "on the display", result.study.data.images[:SHOWN]),
        ("features", "the first channel; gray is 0", gray),
    )
    return [Picture(name, "", text, _large(np.hstack([*pixels]))) for name, text, pixels in named]


def _large(pixels: Array) -> Image.Image:
    times = max(480 // pixels.shape[1], 1)
    return Image.fromarray(np.kron(pixels, np.ones((times, times), np.uint8)))


def _curves(result: Recognition) -> list[Section]:
    out = []
    for name, by_label in result.lines.items():
        axis, title = AXES[name]
        if name == "draws":
            errors = [100 * (1 - r["accuracy"]) for points in by_label.values() for _, r in points]
            text = (
                f"{len(errors)} draws of six types: mean error {np.mean(errors):.2f} %, standard deviation "
                f"{np.std(errors):.2f} %."
            )
            out.append(Section(title, text))
            continue
        series = {label: [(p.x, 100 * r["accuracy"], "") for p, r in points] for label, points in by_label.items()}
        table = [(label, f"{p.x:g}", *_cells(r)[:4]) for label, points in by_label.items() for p, r in points]
        head = ("", axis, *HEAD[1:5])
        text = f"{min(result.study.some, len(result.study.data.labels))} pictures; each point is trained again."
        figure = chart(series, axis, "accuracy, %", title)
        out.append(Section(title, text, charts=[svg(figure)], head=head, rows=table))
    return out


def _alarms(result: Recognition) -> list[Section]:
    if not result.alarms:
        return []
    charts: list[Markup] = []
    table = []
    for contrast, by_label in result.alarms.items():
        percent = f"{100 * float(contrast):g} %"
        series = {name: list(zip(row["false"], row["true"], [""] * len(row["true"]))) for name, row in by_label.items()}
        styles = {name: {"marker": "", "linewidth": 1.6} for name in series}
        title = f"Wake-up at a contrast of {percent}"
        charts.append(svg(chart(series, "false alarms", "detections", title, styles=styles)))
        table += [
            (name, percent, f"{row['auc']:.3f}", f"{row['energy_uj'][0]:.3g}", f"{row['bytes']:.0f}")
            for name, row in by_label.items()
        ]
    head = ("", "contrast", "area below the curve", "sensor, uJ", "bytes")
    text = "Is anything there? A disc enters a smooth background while the light drifts by 10 % from frame to frame."
    return [Section("Wake-up", text, charts=charts, head=head, rows=table)]


def _gestures(result: Recognition) -> list[Section]:
    if not result.gestures:
        return []
    text = (
        f"{', '.join(MOVES)}: which movement? {FRAMES} frames of a bar or square on a smooth background, under light "
        "that drifts by 10 % from frame to frame."
    )
    return [Section("Gestures", text, head=HEAD, rows=gesture_rows(result.summary))]


def _intensity(result: Recognition) -> list[Section]:
    if not result.intensity:
        return []
    text = (
        f"Held-out pictures from frames of which a pixel in {1 / ACTIVE:.0f} is active. The mean is the truth's; one "
        "factor for the contrast, and the regressions, are learned from other pictures."
    )
    pictures = [
        Picture(f"intensity_{name}", "", f"{name}: {', '.join(found['methods'])}", _large(_pixels(found)))
        for name, found in result.intensity.items()
    ]
    rows = intensity_rows(result.summary)
    return [
        Section("Intensity from one binary frame (Sec. A.5)", text, pictures=pictures, head=INTENSITY_HEAD, rows=rows)
    ]


def _pose(result: Recognition) -> list[Section]:
    if not result.pose:
        return []
    text = (
        f"Yaw up to {YAW:g} and pitch up to {PITCH:g} degrees of rendered heads, by ridge regression in a Gaussian "
        "kernel: mean absolute error of held-out heads."
    )
    pictures = [Picture("pose", "", "heads, and their binary gradients", _large(_pixels(dict(result.pose))))]
    return [Section("Head pose", text, pictures=pictures, head=POSE_HEAD, rows=pose_rows(result.summary))]


def _pixels(recovered: dict[str, Any]) -> Array:
    return np.frombuffer(bytes.fromhex(recovered["pixels"]), np.uint8).reshape(recovered["size"])
