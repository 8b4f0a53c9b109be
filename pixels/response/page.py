"""The page of a process's pixel: cross-section, curves and Eq. 3.1, geometries tried, sensitivities."""

import io
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from talbot.base import page
from talbot.base.charts import LINE, SCATTER, curves, front, save, svg
from talbot.base.page import TABLES, Section, Tile
from talbot.models.parameters import TileParameters
from talbot.pixels.optics.closed_form import angular_frequency, talbot_depth
from talbot.pixels.optics.design import SEARCH_ORDERS, Design
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.scalar import crosstalk
from talbot.pixels.optics.solve import Floats
from talbot.pixels.response.errors import BAND_ALL, NODES_ALL, ORDERS_ALL, SAMPLES_ALL, STEP_LEAST, Kept
from talbot.pixels.response.pictures import around, cross_section, responses
from talbot.pixels.response.search import Found, Plan
from talbot.pixels.response.types import CURVE_ORDERS, RAY_DEGREES, Measured, scalar_fit
from talbot.platforms.materials import refractive_index

NAMES = ("pixel.html", "summary.json", "response.npz", "cross_section.png", "response.png", "types.png", "tile.gds")
CROSSING = 0, 10, 20  # degrees
NARROW_NM, WIDE_NM = 50, 100  # classes of bandwidth


def write(
    folder: Path,
    tile: TileParameters,
    summary: dict[str, Any],
    found: Found,
    measured: dict[float, Measured],
    raised: dict[str, dict[float, Design]],
    wrong: dict[float, list[Kept]],
    rays: dict[float, Floats],
) -> None:
    """Write the page and its pictures into ``folder``, which exists. rays: of `types.solve_around`, by beta."""
    plan = found.plans[0]
    section, shown = cross_section(plan), responses(measured)
    turned = around(tile, plan, measured, rays)
    for figure, name in ((section, "cross_section"), (shown, "response"), (turned, "types")):
        save(figure, folder / f"{name}.png")
    picture = Image.open(io.BytesIO((folder / "response.png").read_bytes()))
    text = page.render(
        TABLES,
        f"{summary['process']}: the angle-sensitive pixel in its metal",
        picture=picture,
        about=f"{plan.kind} gratings for {1e3 * plan.wavelength_um:.0f} nm, heights {summary['heights']}; make pixel",
        tiles=_tiles(summary),
        sections=[
            Section(
                "What was found",
                "Eq. 3.1 fitted to the rigorous response over -20..20 degrees, light without polarization. Residual: "
                "of four diodes against the formula, relative to their mean; unexplained: share of the differences' "
                "variance. Quantum efficiency: share of the light on the pixel that enters the silicon of both diodes.",
                charts=[svg(section), svg(shown)],
            ),
            Section(head=HEAD, rows=[_row(beta, plan, one) for beta, one in measured.items()]),
            Section(
                "The tile's types",
                f"Both diodes over the azimuth of a ray {RAY_DEGREES:g} degrees off the axis, % of the light on the "
                "pixel, each type at its place in the tile; Eq. 3.1 dotted. Types are beta/gamma/alpha.",
                charts=[svg(turned)],
            ),
            Section(
                "Every kind at the wavelength that is best for it",
                "Interleaved diodes are taken as collecting all light on their fingers and nothing else. Bandwidth: of "
                "the wavelengths around at which m is at least half, in steps of those of the search.",
                head=(*KIND_HEAD, "residual"),
                rows=[_kind_row(found, p, beta) for p in found.plans for beta in p.designs],
            ),
            Section(
                "What nothing beats",
                "Designs that no other beats in modulation depth, quantum efficiency and bandwidth, of any beta.",
                charts=[svg(pareto(found))],
                head=KIND_HEAD,
                rows=[(d.geometry.kind, *_figures(d, wide)) for d, wide in found.front],
            ),
            Section("Over wavelength", charts=[svg(figure) for figure in _spectra(measured)]),
            Section(
                "Closed forms",
                "beta = 2 pi z / (n d) for small angles, z between the gratings' middles; half a Talbot depth is n d^2 "
                "/ wavelength.",
                head=("beta", "closed form", "gap um", "gap in half Talbot depths"),
                rows=[_closed(one) for one in measured.values()],
            ),
            *([_finite(measured)] if plan.kind == "amplitude" else []),
            *[_heights(name, designs, measured) for name, designs in raised.items()],
            _errors(wrong),
        ],
    )
    (folder / "pixel.html").write_text(text, encoding="utf-8")


HEAD = ("beta", "is", "alpha", "m", "sigma", "quantum efficiency", "extinction ratio", "diattenuation", "residual")
HEAD += ("unexplained", "bandwidth nm", "metals", "period um", "fill", "analyzer fill")


def _row(beta: float, plan: Plan, one: Measured) -> tuple[str, ...]:
    f, g = one.fit, one.design.geometry
    figures = (f.alpha, f.m, f.sigma, f.quantum_efficiency, f.extinction_ratio, f.diattenuation, f.residual_rms)
    return (
        f"{beta:g}",
        f"{f.beta:.1f}" + ("" if plan.reached(beta) else " (not reached)"),
        *(f"{value:.2f}" for value in (*figures, f.unexplained)),
        f"{1e3 * one.bandwidth_um:.0f}",
        _metals(g),
        *(f"{value:g}" for value in (g.period_um, g.fill, g.analyzer_fill)),
    )


KIND_HEAD = ("kind", "nm", "beta", "metals", "period um", "m", "quantum efficiency", "bandwidth nm")


def _figures(d: Design, bandwidth_um: float, said: str = "") -> tuple[str, ...]:
    figures = f"{d.fit.m:.2f}", f"{d.fit.quantum_efficiency:.3f}", f"{1e3 * bandwidth_um:.0f}"
    made = f"{d.fit.beta:.1f}{said}", _metals(d.geometry), f"{d.geometry.period_um:g}"
    return (f"{1e3 * d.wavelength_um:.0f}", *made, *figures)


def _kind_row(found: Found, plan: Plan, beta: float) -> tuple[str, ...]:
    d = plan.designs[beta]
    said = "" if plan.reached(beta) else f" ({beta:g} not reached)"
    return plan.kind, *_figures(d, found.bandwidth_um(d), said), f"{d.fit.residual_rms:.2f}"


def _metals(geometry: PixelGeometry) -> str:
    return geometry.diffraction + (f" over {geometry.analyzer}" if geometry.analyzer else " over fingers")


def _tiles(s: dict[str, Any]) -> list[Tile]:
    got = [row for row in s["betas"] if row["reached"]]
    kind = "good" if len(got) == len(s["betas"]) else "bad"
    tiles = [Tile(", ".join(f"{row['beta']:.1f}" for row in got) or "none", "beta that can be made", kind)]
    for name, label in (("m", "modulation depth"), ("quantum_efficiency", "quantum efficiency")):
        tiles.append(Tile(", ".join(f"{row[name]:.2f}" for row in s["betas"]), label))
    tiles.append(Tile(", ".join(f"{row['residual_rms']:.2f}" for row in s["betas"]), "residual of Eq. 3.1, rms"))
    return tiles


def _closed(one: Measured) -> tuple[str, ...]:
    g, wavelength = one.design.geometry, one.design.wavelength_um
    index = float(refractive_index("silica", wavelength).real)
    upper = g.stack.metal("diffraction", g.diffraction)
    lower = g.stack.metal("analyzer", g.analyzer).thickness_um / 2 if g.analyzer else 0.0
    between = g.gap_um + upper.thickness_um / 2 + lower
    half = talbot_depth(g.period_um, wavelength, index) / 2
    form = angular_frequency(between, g.period_um, index)
    return f"{one.fit.beta:.1f}", f"{form:.1f}", f"{g.gap_um:.3f}", f"{g.gap_um / half:.2f}"


def _finite(measured: dict[float, Measured]) -> Section:
    rows = []
    for beta, one in measured.items():
        coarse, off = scalar_fit(one)
        leaving = crosstalk(one.design.geometry, np.deg2rad(CROSSING), one.design.wavelength_um)
        figures = (f"{one.fit.beta:.1f}: {coarse.beta:.1f}", f"{one.fit.m:.2f}: {coarse.m:.2f}", f"{off:.2f}")
        rows.append((f"{beta:g}", *figures, *(f"{100 * share:.0f} %" for share in leaving)))
    head = ("beta", "beta, rigorous: scalar", "m", "rms difference", *(f"leaving at {angle} deg" for angle in CROSSING))
    text = "Scalar waves through thin lines and the rigorous solution, and the share of the light through a pixel's "
    text += "gratings that reaches the silicon outside the pixel: by scalar waves, light on one pixel alone."
    return Section("Scalar waves, and the pixel's edge", text, head=head, rows=rows)


def _errors(wrong: dict[float, list[Kept]]) -> Section:
    """Rows of all betas side by side."""
    head = ["kept", *(f"beta {beta:g}: error, s" for beta in wrong)]
    rows = [
        (f"{same[0].kept:g} {same[0].what}", *(f"{one.error:.1e}, {one.seconds:.2f}" for one in same))
        for same in zip(*wrong.values(), strict=True)
    ]
    text = (
        f"Greatest error of a diode's share, and seconds. Orders at 0, 7 and 14 degrees, against {ORDERS_ALL}: the "
        f"search keeps {SEARCH_ORDERS}, the curves {CURVE_ORDERS}. Wavelengths over the filter's 20 nm, against "
        f"{BAND_ALL}. Step of a table in degrees that is cubic between its angles, at all angles {STEP_LEAST:g} "
        f"apart. Angles in each of five views at f/1.2, the view's mean, against {NODES_ALL}. Samples of the field "
        f"of scalar waves, the light that leaves a pixel, against {SAMPLES_ALL}."
    )
    return Section("Error against run time", text, head=tuple(head), rows=rows)


def _heights(name: str, designs: dict[float, Design], measured: dict[float, Measured]) -> Section:
    rows = []
    for beta, design in designs.items():
        ours = measured[beta].design.fit
        pairs = ((getattr(ours, n), getattr(design.fit, n)) for n in ("beta", "m", "residual_rms"))
        rows.append((f"{beta:g}", *(f"{a:.2f}: {b:.2f}" for a, b in pairs)))
    return Section(
        f"With the heights {name}", "The same gratings.", head=("beta", "beta is", "m", "residual"), rows=rows
    )


def pareto(found: Found) -> Figure:
    """Modulation m against quantum efficiency: designs by bandwidth, the chosen ones of each kind, and their front."""
    ends: dict[str, list[tuple[float, float, str]]] = {}
    for low, high, name in (
        (0, NARROW_NM, f"below {NARROW_NM} nm"),
        (NARROW_NM, WIDE_NM, f"{NARROW_NM} to {WIDE_NM} nm"),
        (WIDE_NM, np.inf, f"{WIDE_NM} nm and more"),
    ):
        ends[name] = [_point(design) for design, wide in found.front if low <= round(1e3 * wide) < high]
    for plan in found.plans:
        ends[f"{plan.kind}: chosen"] = [_point(design) for design in plan.designs.values()]
    styles = dict.fromkeys(ends, SCATTER)
    line = "the front, of any bandwidth"
    ends[line], styles[line] = front(_point(design) for design, _ in found.front), LINE
    title = "None better, by bandwidth; numbers: beta"
    return curves(ends, "quantum efficiency", "modulation depth m", title, styles=styles)


def _point(design: Design) -> tuple[float, float, str]:
    return design.fit.quantum_efficiency, design.fit.m, f"{design.fit.beta:.0f}"


def _spectra(measured: dict[float, Measured]) -> list[Figure]:
    out = []
    for name, label in (("m", "modulation depth m"), ("beta", "fitted beta"), ("extinction_ratio", "extinction ratio")):
        series = {
            f"beta {beta:g}": [
                (1e3 * float(w), float(getattr(f, name)), "") for w, f in zip(one.response.wavelengths_um, one.fits)
            ]
            for beta, one in measured.items()
        }
        out.append(curves(series, "wavelength, nm", label, f"{label} over wavelength"))
    return out
