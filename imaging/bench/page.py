"""The files of a calibration from readings: sensor.toml, response.npz, the readings of a simulation, the page."""

from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure as Chart

from talbot.base.charts import LINE, SCATTER, curves, svg
from talbot.base.page import TABLES, Section, Tile, render
from talbot.imaging.bench.chip import Measured
from talbot.imaging.bench.compare import difference_over_sum, fitting_heights
from talbot.models.parameters import TileParameters, sensor_text
from talbot.pixels.measured import write_responses
from talbot.pixels.response.types import name_of

PAGE, SENSOR, RESPONSE, READINGS = "bench.html", "sensor.toml", "response.npz", "measurements.csv"
NAMES = PAGE, SENSOR, RESPONSE, READINGS, "summary.json"
HEAD = ("type", "pixel", "beta", "gamma, degrees", "alpha, rad", "m", "efficiency", "readings", "residual")


def write(folder: Path, done: Measured, about: str) -> None:
    """Write everything but readings and summary.json into ``folder``, which exists. about: where readings are from."""
    names = [name_of(kind) for kind in TileParameters().types]
    write_responses(folder / RESPONSE, names, done.responses, 1e-9 * done.summary["wavelength_nm"])
    text = f"# Measured by talbot calibrate: {about}. PIXEL={RESPONSE}, next to this file, has the types' responses.\n"
    (folder / SENSOR).write_text(text + sensor_text(done.sensor), encoding="utf-8")
    s = done.summary
    html = render(
        TABLES,
        "Pixels of the test chip, measured",
        about=f"{about}: {s['readings']:,} readings, {s['angles']} angles, {s['wavelength_nm']:g} nm, "
        f"{s['celsius']:.1f} degrees C",
        tiles=_tiles(s),
        sections=[
            *([Section("To check", rows=[(note,) for note in s["notes"]], numbers=False)] if s["notes"] else []),
            Section("Chip", "With standard errors.", head=("", "measured", *["true"] * ("truth" in s)), rows=rows(s)),
            Section(
                "Pixel types",
                "Efficiency: light of both diodes over that of a plain pixel, mean over the angles.",
                head=HEAD,
                rows=type_rows(s),
            ),
            Section(
                "Difference over sum",
                "Of each type across its lines. Measured: every angle of the stage. Fitted: Eq. 3.1, or a table "
                "around it for rays across the lines.",
                charts=charts(done),
            ),
        ],
    )
    (folder / PAGE).write_text(html, encoding="utf-8")


def rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the summary ``s`` about the whole chip; with what a simulation had put in."""
    truth = s.get("truth")
    table = [
        ("gain of the followers, V/V", with_error(s["follower_gain"], 4), f"{truth['gain']:.4f}" if truth else ""),
        (
            f"pads at a reset level of {s['follower_offset_at_v']:g} V, V",
            f"{with_error(s['follower_offset_v'], 4)}, spread {s['follower_offset_spread_v']:.4f}",
            "",
        ),
        ("rise of the capacitance, 1/V", with_error(s["capacitance_rise"], 3), f"{truth['bend']:.3f}" if truth else ""),
        (
            f"dark current at {s['dark_celsius']:.0f} degrees C, mV/s",
            with_error(s["dark_v_per_s"], 2, 1e3),
            f"{1e3 * truth['dark'][0]:.2f}" if truth else "",
        ),
        ("doubles every, K", _number(s["dark_doubling_k"], 1), f"{truth['doubling']:.1f}" if truth else ""),
        (
            "crosstalk into a covered pixel, %",
            with_error(s["crosstalk"], 3, 100),
            f"{100 * truth['crosstalk']:.3f}" if truth else "",
        ),
        (
            "sigma of the aperture, rad",
            f"{s['sigma']:.4f}",
            f"{truth['sigma']:.4f}" if truth and truth["sigma"] else "",
        ),
        (
            "zero of the stage by the sums, inner, outer, degrees",
            ", ".join(f"{value:+.2f}" for value in s["stage_zero_deg"]),
            "+0.00, +0.00" if truth else "",
        ),
        ("lamp and noise of the plain pixels, rms %", f"{100 * s['lamp_rms']:.2f}", ""),
        ("heights of the metals", fitting_heights(s), ""),
    ]
    return [row if truth else row[:2] for row in table]


def type_rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the types."""
    digits = {"beta": 2, "gamma_deg": 2, "alpha": 3, "m": 3}
    errors = {"beta": "beta_error", "gamma_deg": "gamma_error", "alpha": "alpha_error", "m": "m_error"}
    return [
        (
            f"{number}: {name_of(nominal)}",
            f"{kind['row']},{kind['col']}",
            *(f"{kind[name]:.{d}f} ± {kind[errors[name]]:.{d + 1}f}" for name, d in digits.items()),
            with_error(kind["efficiency"], 4),
            str(kind["readings"]),
            f"{kind['residual']:.4f}",
        )
        for number, (kind, nominal) in enumerate(zip(s["types"], TileParameters().types, strict=True))
    ]


def with_error(figure: dict[str, float | None] | None, digits: int, scale: float = 1.0) -> str:
    """Return a figure and its standard error as a text."""
    if figure is None or figure["value"] is None:
        return "not measured"
    text = f"{scale * figure['value']:.{digits}f}"
    return text if figure["error"] is None else f"{text} ± {scale * figure['error']:.{digits}f}"


def charts(done: Measured) -> list[Markup]:
    """Return a chart of every type."""
    return [svg(_chart(done, k)) for k in range(len(done.fits))]


def _chart(done: Measured, number: int) -> Chart:
    kind, response = done.fits[number].kind, done.responses[number]
    y, x = np.arctan(done.angles.tangents).T
    nominal = TileParameters().types[number]
    gamma = kind.gamma if kind.m else nominal.gamma
    along = np.rad2deg(x * np.cos(gamma) + y * np.sin(gamma))
    q = difference_over_sum(done.signals[:, number])
    wave = difference_over_sum(np.asarray(response.values[:, :, 0].T, np.float64))
    points = {
        "fitted": [(u, v, "") for u, v in zip(np.rad2deg(response.along), wave, strict=True) if np.isfinite(v)],
        "measured": [(u, v, "") for u, v in zip(along, q, strict=True) if np.isfinite(v)],
    }
    title = f"Type {number}, {name_of(nominal)}: beta {kind.beta:.2f}, m {kind.m or 0:.3f}"
    return curves(
        points, "degrees across the lines", "(a - b) / (a + b)", title, styles={"fitted": LINE, "measured": SCATTER}
    )


def _tiles(s: dict[str, Any]) -> list[Tile]:
    good = [kind for kind in s["types"] if kind["m"]]
    return [
        Tile(
            f"{len(good)} of {len(s['types'])}",
            "types with a modulation",
            "good" if len(good) == len(s["types"]) else "bad",
        ),
        Tile(f"{np.mean([kind['m'] for kind in good]) if good else 0:.3f}", "mean m"),
        Tile(f"{max((kind['m_error'] for kind in good), default=1):.4f}", "largest standard error of m"),
        Tile(with_error(s["dark_v_per_s"], 2, 1e3), "dark current, mV/s"),
        Tile(with_error(s["crosstalk"], 2, 100), "crosstalk, %"),
    ]


def _number(value: float | None, digits: int) -> str:
    return "not measured" if value is None else f"{value:.{digits}f}"
