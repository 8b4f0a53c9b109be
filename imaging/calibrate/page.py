"""The files of a calibration: calibration.json, its page, the bench's means."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from talbot.base.charts import LINE, SCATTER, curves, svg
from talbot.base.page import TABLES, Section, Tile, render
from talbot.imaging.calibrate.measure import Calibrated
from talbot.imaging.frame.reading import number
from talbot.models.parameters import OpticsParameters
from talbot.models.pixel.weights import density

NAMES = ("calibrate.html", "calibration.json", "summary.json", "sweep.npz")
NEAR = 0.12  # of the pupil's radius
HEAD = ("type", "beta", "true", "gamma", "true", "alpha", "true", "m", "true", "residual", "condition")


def write(folder: Path, done: Calibrated) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    s, sweep = done.summary, done.sweep
    table = done.calibration.table
    (folder / "calibration.json").write_text(json.dumps(table, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    np.savez(folder / "sweep.npz", holes=sweep.holes, diodes=sweep.diodes, places=sweep.places, gains=sweep.gains)
    text = render(
        TABLES,
        "Calibration on the bench",
        about=f"{s['rows']} x {s['cols']} pixels, {s['holes']} places of the hole, noise {s['noise']:g}",
        tiles=_tiles(s),
        sections=[
            Section(
                "What it leaves in a picture",
                f"The light field of {s['picture']['scene']}, read back with the calibration and with the true optics.",
                head=("", "calibrated, dB", "true optics, dB"),
                rows=picture_rows(s),
            ),
            Section("Lens", head=("", "measured", "true"), rows=lens_rows(s)),
            Section(
                "Difference over sum, of rays across the pupil",
                "Measured: mean of a type's pixels in a block, nu_y near 0. Fitted: Eq. 3.1, or a table around it.",
                charts=[svg(figure) for figure in _figures(done)],
            ),
            Section("Pixel types", head=HEAD, rows=[_row(i, kind) for i, kind in enumerate(s["types"])]),
        ],
    )
    (folder / "calibrate.html").write_text(text, encoding="utf-8")


def picture_rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the summary ``s``: methods, then baselines."""
    picture = s["picture"]
    rows = [(name, number(db), number(picture["true_optics"][name])) for name, db in picture["calibrated"].items()]
    free = [("sum image in every view", "sum_image_psnr_db"), ("gray", "gray_psnr_db")]
    return rows + [(name, number(picture[key]), "") for name, key in free]


def lens_rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the summary ``s`` about the lens."""
    centre = "not seen" if s["centre"] is None else ", ".join(f"{value:+.2f} px" for value in s["centre"])
    power = f"{s['pupil_power']:.2f} +- {s['pupil_power_error']:.2f}", f"{s['pupil_power_true']:.2f}"
    return [
        ("sigma of the aperture, rad", f"{s['sigma']:.4f}", f"{s['sigma_true']:.4f}"),
        ("power of the exit pupil, 1/m", *power),
        ("optical centre from the middle, y, x", centre, "+0.00 px, +0.00 px"),
    ]


def _tiles(s: dict[str, Any]) -> list[Tile]:
    best = max(s["picture"]["true_optics"], key=lambda name: s["picture"]["true_optics"][name] or 0)
    lost = (s["picture"]["true_optics"][best] or 0) - (s["picture"]["calibrated"][best] or 0)
    return [
        Tile(f"{lost:.2f} dB", f"lost by the calibration ({best})"),
        Tile(
            f"{s['response_rms']:.4f}", f"RMS error of difference over sum (of none: {s['response_rms_constant']:.2f})"
        ),
        Tile(f"{s['gains_rms']:.4f}", "RMS error of the trims' ratios"),
        Tile(f"{s['condition']:.1f}", "condition of the worst fit"),
        Tile(f"{s['seconds_bench'] + s['seconds_fit']:.0f} s", "for bench and fit"),
    ]


def _row(number_: int, kind: dict[str, Any]) -> tuple[str, ...]:
    pairs = [("beta", 2), ("gamma_deg", 2), ("alpha", 3), ("m", 3)]
    values = [f"{kind[name + end]:.{digits}f}" for name, digits in pairs for end in ("", "_true")]
    return (str(number_), *values, f"{kind['residual']:.4f}", f"{kind['condition']:.2f}")


def _figures(done: Calibrated) -> list[Figure]:
    """Measured and fitted ratios of a type of each angular frequency."""
    sweep, types = done.sweep, done.calibration.types
    row = np.abs(sweep.holes[:, 0]) < NEAR * np.abs(sweep.holes).max()
    block = np.argmin(np.abs(np.nanmean(sweep.places, 1)).sum(1))
    out = []
    for beta in sorted({round(kind.beta / 6) * 6 for kind in types}):
        chosen = min(range(len(types)), key=lambda i: abs(types[i].beta - beta) + abs(types[i].gamma_deg) / 90)
        kind, (a, b) = types[chosen], sweep.diodes[row, block, chosen].T
        nu = sweep.holes[row, 1]
        fine = np.linspace(nu.min(), nu.max(), 121)
        first, second = density((kind,), OpticsParameters(m=kind.m or 0), fine, 0 * fine)[0]
        wave = (first - second) / np.maximum(first + second, 1e-12)
        points = {
            "fitted": [(x, y, "") for x, y in zip(fine, wave, strict=True)],
            "measured": [(x, y, "") for x, y in zip(nu, (a - b) / (a + b), strict=True)],
        }
        title, styles = f"Type {chosen}: beta {kind.beta:.2f}", {"fitted": LINE, "measured": SCATTER}
        out.append(curves(points, "nu_x", "(a - b) / (a + b)", title, styles=styles))
    return out
