"""The files of a comparison: page, tables of a document."""

import io
from collections import defaultdict
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from talbot.base.charts import curves, save, svg
from talbot.base.page import TABLES, Section, Tile, render
from talbot.imaging.cameras.measure import ASP, COPIED, PLAIN
from talbot.imaging.frame.reading import number
from talbot.models.reconstruct.bayes import FieldPrior

NAMES = ("cameras.html", "summary.json")
TEXTS = {
    ASP: "ASP",
    "lenslets": "lenslets",
    "mask": "coded mask",
    "random": "random projections",
    PLAIN: "plain, learned disparity",
    COPIED: "plain, copied",
}
SERIES = {("asp", "regular"): "ASP", ("asp", "random"): "ASP, random tile", ("mask", "regular"): "mask"}
SERIES |= {("mask", "random"): "mask, random tile", ("random", "regular"): "random projections"}
SERIES |= {("random", "random"): "random projections, random tile"}
Row = dict[str, Any]
Table = tuple[Sequence[str], list[tuple[str, ...]]]


def mean(rows: Sequence[Row], key: str) -> float | None:
    """Return the mean of a figure over rows; None where no row has it."""
    values = [row[key] for row in rows if row[key] is not None]
    return float(np.mean(values)) if values else None


def spread(s: Row) -> float:
    """Return the largest standard deviation over seeds of the PSNR of a camera, scene and light, in dB."""
    groups: dict[tuple[Any, ...], list[float]] = defaultdict(list)
    for row in s["rows"]:
        groups[row["camera"], row["method"], row["scene"], row["lux"]].append(row["psnr_db"])
    return max(float(np.std(values)) for values in groups.values())


def best(s: Row, camera: str, lux: float) -> list[Row]:
    """Return the rows of a camera in one light by the method with the highest PSNR over all scenes."""
    some = [row for row in s["rows"] if row["camera"] == camera and row["lux"] == lux]
    methods = {method: [row for row in some if row["method"] == method] for method in {row["method"] for row in some}}
    return max(methods.values(), key=lambda rows: mean(rows, "psnr_db") or 0.0)


def overview(s: Row) -> Table:
    """Return the table of all figures in the brightest light, means over scenes and seeds."""
    head = ("camera", "light", "method", "PSNR, dB", "SSIM", "disparity, px", "SNR, dB", "bytes", "uJ")
    rows = []
    for name, text in TEXTS.items():
        some = best(s, name, s["lux"][0])
        rows.append(
            (
                text,
                f"{s['light'][PLAIN if name == COPIED else name]:g}",
                some[0]["method"],
                number(mean(some, "psnr_db"), 1),
                number(mean(some, "ssim"), 3),
                "-" if name == COPIED else number(mean(some, "disparity_rms_px"), 2),
                number(mean(some, "snr_db"), 1),
                f"{mean(some, 'bytes') or 0:.0f}",
                number(mean(some, "energy_uj"), 2),
            )
        )
    return head, rows


def light(s: Row) -> Table:
    """Return the table of the PSNR of the views over light, with the disparity's error in px."""
    rows = [(text, *(_quality(name, best(s, name, lux)) for lux in s["lux"])) for name, text in TEXTS.items()]
    return ["camera", *(f"{lux:g} lx" for lux in s["lux"])], rows


def _quality(name: str, rows: list[Row]) -> str:
    error = "" if name == COPIED else f" ({number(mean(rows, 'disparity_rms_px'), 2)})"
    return number(mean(rows, "psnr_db"), 1) + error


def by_scene(s: Row) -> Table:
    """Return the table of the PSNR of every scene in the brightest light, with the disparity's error in px."""
    rows = []
    for name, text in TEXTS.items():
        some = best(s, name, s["lux"][0])
        cells = (_quality(name, [row for row in some if row["scene"] == scene]) for scene in s["scenes"])
        rows.append((text, *cells))
    return ["camera", *(f"`{scene}`" for scene in s["scenes"])], rows


def measurements(s: Row) -> Table:
    """Return the table of the PSNR over the number of measurements a pixel, with regular tiles."""
    psnr = {(p["camera"], p["tile"], p["measurements"]): p["psnr_db"] for p in s["measurements"]}
    shares = dict(sorted((p["measurements"], p["share"]) for p in s["measurements"]))
    head = ["measurements a pixel", *(f"{count:g} ({100 * share:.0f} %)" for count, share in shares.items())]
    regular = {key: text for key, text in SERIES.items() if key[1] == "regular"}
    rows = [(text, *(number(psnr.get((*key, count)), 1) for count in shares)) for key, text in regular.items()]
    return head, rows


def tables(swept: bool) -> dict[str, Callable[[Row], Table]]:
    """Return the tables of a document by their marks. swept: with `measurements`."""
    every = {"cameras": overview, "light": light, "scenes": by_scene}
    return every | {"measurements": measurements} if swept else every


def line(s: Row) -> str:
    """Return what was compared, in a line."""
    exposure, seeds = f"{1e3 * s['exposure_s']:.2f} ms", f"{s['seeds']} seed{'s' * (s['seeds'] > 1)}"
    return (
        f"{len(s['scenes'])} scenes of {s['size']} x {s['size']} pixels, {seeds}, {exposure} of "
        f"{', '.join(f'{lux:g}' for lux in s['lux'])} lux; plain camera: {s['plain']['disparity']:+g} px a view step"
    )


def write(folder: Path, s: Row) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    about = f"Means over scenes and seeds in {s['lux'][0]:g} lux"
    about += f"; seeds differ by {spread(s):.2f} dB RMS at most." if s["seeds"] > 1 else "."
    charts = _charts(s)
    parts = [
        _section("Cameras", about, overview(s)),
        _section("Light", "One exposure for all. PSNR in dB (RMS error of disparity in px).", light(s), charts),
        _section("Scenes", "PSNR in dB (RMS error of disparity in px).", by_scene(s)),
    ]
    if s["measurements"]:
        size = f"{s['swept_size']} x {s['swept_size']} pixels"
        noise = f"noise {FieldPrior.noise:g} of white in every sample"
        text = f"PSNR in dB, mean of {', '.join(s['swept_scenes'])}, {size}; {noise}."
        parts.append(_section("Measurements a pixel", text, measurements(s), [_swept(s)]))
    picture = _picture(charts[0])
    text = render(TABLES, "Cameras for light fields", picture=picture, about=line(s), tiles=_tiles(s), sections=parts)
    (folder / "cameras.html").write_text(text, encoding="utf-8")


def _section(title: str, text: str, table: Table, charts: Sequence[Any] = ()) -> Section:
    head, rows = table
    return Section(title, text, [svg(chart) for chart in charts], head=head, rows=rows)


def _tiles(s: Row) -> list[Tile]:
    bright = {name: mean(best(s, name, s["lux"][0]), "psnr_db") or 0.0 for name in TEXTS}
    first = max(bright, key=lambda name: bright[name])
    return [
        Tile(f"{bright[ASP]:.1f} dB", "PSNR of the views by ASP"),
        Tile(f"{bright[first]:.1f} dB", f"by the best camera: {TEXTS[first]}"),
        Tile(f"{bright[COPIED]:.1f} dB", f"by {TEXTS[COPIED].removeprefix('plain, ')}"),
    ]


def _charts(s: Row) -> list[Any]:
    out = []
    for key, text, title in (
        ("psnr_db", "PSNR of the views (dB)", "Views over light"),
        ("ssim", "SSIM of the views", "Similarity over light"),
        ("disparity_rms_px", "RMS error (px a view step)", "Disparity over light"),
        ("snr_db", "SNR of the samples (dB)", "Samples over light"),
    ):
        series = {}
        for name, label in TEXTS.items():
            if name == COPIED and key in ("disparity_rms_px", "snr_db"):
                continue
            points = [(lux, mean(best(s, name, lux), key), "") for lux in s["lux"]]
            series[label] = [(x, y, label) for x, y, label in points if y is not None]
        out.append(curves(series, "illuminance of white (lux)", text, title, log_x=True))
    return out


def _swept(s: Row) -> Any:
    series: dict[str, list[tuple[float, float, str]]] = {}
    for p in s["measurements"]:
        text = SERIES[p["camera"], p["tile"]]
        series.setdefault(text, []).append((100 * p["share"], p["psnr_db"], ""))
    return curves(series, "measurements over views (%)", "PSNR of the views (dB)", "Measurements a pixel", log_x=True)


def _picture(chart: Any) -> Image.Image:
    out = io.BytesIO()
    save(chart, out)
    return Image.open(out).convert("RGB")
