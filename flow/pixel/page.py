"""The page of a process's pixel: cross-section, curves beside Eq. 3.1, what was tried, what moves the result."""

import io
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from PIL import Image

from talbot.base import page
from talbot.base.charts import COLOURS, curves, save, svg
from talbot.base.page import TABLES, Section, Tile
from talbot.pixels.optics.closed_form import angular_frequency, talbot_depth
from talbot.pixels.optics.design import SEARCH_ORDERS, Design
from talbot.pixels.optics.field import field_between
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.scalar import crosstalk
from talbot.platforms.materials import refractive_index

from .search import Found, Plan
from .types import CURVE_ORDERS, REFERENCE, Measured, beside

NAMES = ("pixel.html", "summary.json", "response.npz", "cross_section.png", "response.png")
MATERIALS = {"silica": "#dfe6ee", "nitride": "#b9d3b0", "aluminium": "#8a8f99", "silicon": "#a8664f"}
CROSSING = 0, 10, 20  # degrees
WIDTH_UM = 2.4  # of the cross-section


def write(
    folder: Path,
    summary: dict[str, Any],
    found: Found,
    measured: dict[float, Measured],
    raised: dict[str, dict[float, Design]],
) -> None:
    """Write the page and its pictures into ``folder``, which exists."""
    plan = found.plans[0]
    section, shown = cross_section(plan), responses(measured)
    for figure, name in ((section, "cross_section"), (shown, "response")):
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
                charts=[svg(section), svg(shown), svg(polar(measured))],
            ),
            Section(head=HEAD, rows=[_row(beta, plan, one) for beta, one in measured.items()]),
            Section(
                "Every kind at the wavelength that is best for it",
                "Interleaved diodes are taken as collecting all light on their fingers and nothing else.",
                charts=[svg(_pareto(found))],
                head=("kind", "nm", "beta", "is", "metals", "period um", "m", "quantum efficiency", "residual"),
                rows=[_kind_row(p, beta) for p in found.plans for beta in p.designs],
            ),
            Section("Over wavelength", charts=[svg(figure) for figure in _spectra(measured)]),
            Section(
                "Closed forms beside it",
                "beta = 2 pi z / (n d) for small angles, z between the gratings' middles; half a Talbot depth is n d^2 "
                "/ wavelength.",
                head=("beta", "closed form", "gap um", "gap in half Talbot depths"),
                rows=[_closed(one) for one in measured.values()],
            ),
            *([_finite(measured)] if plan.kind == "amplitude" else []),
            *[_heights(name, designs, measured) for name, designs in raised.items()],
            Section(
                "Error against run time",
                f"Greatest error of a diode's share at 0, 7 and 14 degrees against {REFERENCE} orders, and seconds for "
                f"them, of the finest type. The search keeps {SEARCH_ORDERS}, the curves {CURVE_ORDERS}.",
                head=("orders", "error", "seconds"),
                rows=[
                    (str(row["orders"]), f"{row['error']:.1e}", f"{row['seconds']:.2f}") for row in summary["orders"]
                ],
            ),
        ],
    )
    (folder / "pixel.html").write_text(text)


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


def _kind_row(plan: Plan, beta: float) -> tuple[str, ...]:
    d = plan.designs[beta]
    f, g = d.fit, d.geometry
    figures = f"{f.m:.2f}", f"{f.quantum_efficiency:.3f}", f"{f.residual_rms:.2f}"
    said = "" if plan.reached(beta) else " (not reached)"
    light = f"{1e3 * plan.wavelength_um:.0f}"
    return (plan.kind, light, f"{beta:g}", f"{f.beta:.1f}{said}", _metals(g), f"{g.period_um:g}", *figures)


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
        coarse, off = beside(one)
        leaving = crosstalk(one.design.geometry, np.deg2rad(CROSSING), one.design.wavelength_um)
        figures = (f"{one.fit.beta:.1f}: {coarse.beta:.1f}", f"{one.fit.m:.2f}: {coarse.m:.2f}", f"{off:.2f}")
        rows.append((f"{beta:g}", *figures, *(f"{100 * share:.0f} %" for share in leaving)))
    head = ("beta", "beta, rigorous: scalar", "m", "rms difference", *(f"leaving at {angle} deg" for angle in CROSSING))
    text = "Scalar waves through thin lines beside the rigorous solution, and the share of the light through a pixel's "
    text += "gratings that reaches the silicon outside the pixel: by scalar waves, light on one pixel alone."
    return Section("Scalar waves, and the pixel's edge", text, head=head, rows=rows)


def _heights(name: str, designs: dict[float, Design], measured: dict[float, Measured]) -> Section:
    rows = []
    for beta, design in designs.items():
        ours = measured[beta].design.fit
        pairs = ((getattr(ours, n), getattr(design.fit, n)) for n in ("beta", "m", "residual_rms"))
        rows.append((f"{beta:g}", *(f"{a:.2f}: {b:.2f}" for a, b in pairs)))
    return Section(
        f"With the heights {name}", "The same gratings.", head=("beta", "beta is", "m", "residual"), rows=rows
    )


def responses(measured: dict[float, Measured]) -> Figure:
    """The four diodes of each design over angle, and the formula fitted to them, dotted."""
    figure = Figure(figsize=(4 * len(measured), 3.2), layout="constrained")
    for axes, (beta, one) in zip(figure.subplots(1, len(measured), squeeze=False)[0], measured.items(), strict=True):
        middle = len(one.fits) // 2
        shares, angles = one.response.unpolarized[middle], one.response.angles
        form = one.fit.curve(angles)
        form *= shares.mean() / form.mean()
        for k, colour in enumerate(COLOURS[:4]):
            axes.plot(np.rad2deg(angles), 100 * shares[k], color=colour, linewidth=1.4)
            axes.plot(np.rad2deg(angles), 100 * form[k], ":", color=colour, linewidth=1)
        axes.set_title(f"beta {beta:g}: {one.fit.beta:.1f}, m {one.fit.m:.2f}", fontsize=10, loc="left")
        axes.set_xlabel("angle, degrees", fontsize=9)
        axes.set_ylabel("light in a diode, % of the pixel's", fontsize=9)
        axes.tick_params(labelsize=8)
        axes.grid(alpha=0.25)
    return figure


def polar(measured: dict[float, Measured]) -> Figure:
    """A pair of diodes of each design as antennas are drawn, along the ray's direction; the formula dotted."""
    figure = Figure(figsize=(4 * len(measured), 2.6), layout="constrained")
    panels = figure.subplots(1, len(measured), squeeze=False, subplot_kw={"projection": "polar"})[0]
    for axes, (beta, one) in zip(panels, measured.items(), strict=True):
        shares, angles = one.response.unpolarized[len(one.fits) // 2], one.response.angles
        form = one.fit.curve(angles)
        form *= shares.mean() / form.mean()
        for diode, colour in zip((0, 2), COLOURS, strict=False):
            axes.plot(angles, 100 * shares[diode], color=colour, linewidth=1.4)
            axes.plot(angles, 100 * form[diode], ":", color=colour, linewidth=1)
        axes.set_theta_zero_location("N")
        axes.set_thetalim(float(angles.min()), float(angles.max()))
        axes.set_title(f"beta {beta:g}: a pair of diodes, %", fontsize=9, loc="left")
        axes.tick_params(labelsize=7)
    return figure


def cross_section(plan: Plan) -> Figure:
    """Lines, films and silicon of each design, to scale; with an analyzer also the light between the gratings.

    That of a wave on the axis, which the first diode passes, and at the angle at which the second has its place.
    """
    panels: list[tuple[Design, float, float]] = []
    for beta, design in plan.designs.items():
        angles = (0.0, np.pi / design.fit.beta) if plan.kind == "amplitude" else (0.0,)
        panels += [(design, beta, angle) for angle in angles]
    figure = Figure(figsize=(1.9 * len(panels), 4.2), layout="constrained")
    for axes, (design, beta, angle) in zip(figure.subplots(1, len(panels), sharey=True, squeeze=False)[0], panels):
        g = design.geometry
        bottom = g.stack.surface_um
        for film in g.stack.films:
            axes.add_patch(Rectangle((0, bottom), WIDTH_UM, film.top_um - bottom, color=MATERIALS[film.material]))
            bottom = film.top_um
        axes.add_patch(Rectangle((0, 0), WIDTH_UM, g.stack.surface_um, color="#6a5f7a"))
        if plan.kind == "amplitude":
            _light(axes, design, angle)
        gratings = [("diffraction", g.diffraction, g.fill, 0.0, 1)]
        gratings += [("analyzer", g.analyzer, g.analyzer_fill, g.shift, g.lines)] if g.analyzer else []
        for field, name, fill, shift, lines in gratings:
            metal = g.stack.metal(field, name)
            for k in range(-lines, int(lines * (WIDTH_UM / g.period_um + 1))):
                left = max(0.0, (k / lines + 0.5 + shift - fill / lines / 2) * g.period_um)
                right = min(WIDTH_UM, (k / lines + 0.5 + shift + fill / lines / 2) * g.period_um)
                if right > left:
                    place = (left, metal.bottom_um)
                    axes.add_patch(Rectangle(place, right - left, metal.thickness_um, color=MATERIALS[metal.material]))
        axes.set(xlim=(0, WIDTH_UM), ylim=(0, g.stack.films[-1].top_um + 0.3), aspect="equal")
        axes.set_title(f"beta {beta:g}, {np.rad2deg(angle):.1f}°", fontsize=9, loc="left")
        axes.set_xlabel("µm", fontsize=8)
        axes.tick_params(labelsize=7)
    return figure


def _light(axes: Axes, design: Design, angle: float) -> None:
    """Draw the field between the gratings."""
    g = design.geometry
    lower = g.stack.metal("analyzer", str(g.analyzer)).top_um
    x, up = np.linspace(0, WIDTH_UM, 240), np.linspace(0, g.gap_um, 240)
    # Lines of the picture stand half a period from its edge
    field = field_between(g, angle, design.wavelength_um, x - g.period_um / 2, up)
    place = (0, WIDTH_UM, lower, lower + g.gap_um)
    axes.imshow(
        field, cmap="inferno", extent=place, origin="lower", vmin=0, vmax=float(np.quantile(field, 0.995)), zorder=2
    )


def _pareto(found: Found) -> Figure:
    ends: dict[str, list[tuple[float, float, str]]] = {}
    for design in found.front:
        label = f"{design.fit.beta:.0f}"
        ends.setdefault(f"{design.geometry.kind}: none better", []).append(
            (design.fit.quantum_efficiency, design.fit.m, label)
        )
    for plan in found.plans:
        points = [(d.fit.quantum_efficiency, d.fit.m, f"{d.fit.beta:.0f}") for d in plan.designs.values()]
        ends[f"{plan.kind}: chosen"] = sorted(points)
    return curves(ends, "quantum efficiency", "modulation depth m", "What can be made; numbers: beta")


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
