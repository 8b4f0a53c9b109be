"""Pictures of a plan's pixels: cross-section with the light in it, responses and Eq. 3.1."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator

from talbot.base.charts import COLOURS
from talbot.models.parameters import TileParameters
from talbot.pixels.optics.design import Design
from talbot.pixels.optics.field import field_between
from talbot.pixels.optics.solve import Floats
from talbot.pixels.response.search import Plan
from talbot.pixels.response.types import AZIMUTHS, Measured, across_lines, name_of, nearest
from talbot.pixels.tabled import rows

MATERIALS = {"silica": "#dfe6ee", "nitride": "#b9d3b0", "aluminium": "#8a8f99", "silicon": "#a8664f"}
WIDTH_UM = 2.4  # of the cross-section


def responses(measured: Mapping[float, Measured]) -> Figure:
    """Return the four diodes of each design over angle, and the formula fitted to them, dotted."""
    figure = Figure(figsize=(4 * len(measured), 3.2), layout="constrained")
    for axes, (beta, one) in zip(figure.subplots(1, len(measured), squeeze=False)[0], measured.items(), strict=True):
        middle = len(one.fits) // 2
        shares, angles = one.response.unpolarized[middle], one.response.angles
        form = one.fit.curve(angles) * one.level
        for k, colour in enumerate(COLOURS[:4]):
            axes.plot(np.rad2deg(angles), 100 * shares[k], color=colour, linewidth=1.4)
            axes.plot(np.rad2deg(angles), 100 * form[k], ":", color=colour, linewidth=1)
        axes.set_title(f"beta {beta:g}: {one.fit.beta:.1f}, m {one.fit.m:.2f}", fontsize=10, loc="left")
        axes.set_xlabel("angle, degrees", fontsize=9)
        axes.set_ylabel("light in a diode, % of the pixel's", fontsize=9)
        axes.tick_params(labelsize=8)
        axes.grid(alpha=0.25)
    return figure


def around(
    tile: TileParameters, plan: Plan, measured: Mapping[float, Measured], shares: Mapping[float, Floats]
) -> Figure:
    """Both diodes of every type, at its place in the tile, over the azimuth of a ray `RAY_DEGREES` off the axis.

    The formula is dotted. shares: (4, azimuths) of each beta, of `types.solve_around`. The sensor's y runs down.
    """
    figure = Figure(figsize=(1.65 * tile.cols, 1.75 * tile.rows), layout="constrained")
    panels = figure.subplots(tile.rows, tile.cols, squeeze=False, subplot_kw={"projection": "polar"}).flat
    for axes, number in zip(panels, tile.order, strict=True):
        kind = tile.types[number]
        beta = nearest(plan, kind.beta)
        one, azimuths = measured[beta], np.append(AZIMUTHS, 2 * np.pi)
        form = one.fit.curve(across_lines(azimuths)) * one.level
        for diode, colour in zip(rows(kind.alpha, one.fit), COLOURS):
            closed = np.append(shares[beta][diode], shares[beta][diode][0])
            axes.plot(azimuths + kind.gamma, 100 * closed, color=colour, linewidth=1.2)
            axes.plot(azimuths + kind.gamma, 100 * form[diode], ":", color=colour, linewidth=0.9)
        axes.set_theta_direction(-1)
        axes.set(xticklabels=[], ylim=(0, None))
        axes.set_title(name_of(kind), fontsize=7, pad=2)
        axes.yaxis.set_major_locator(MaxNLocator(2))
        axes.tick_params(labelsize=6)
        axes.grid(alpha=0.25)
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
