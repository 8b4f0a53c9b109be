"""Charts (Matplotlib, no display): `bars` and `curves` make a figure, `svg` and `save` put it out."""

import io
import os
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import Any, BinaryIO

import numpy as np
from markupsafe import Markup, escape
from matplotlib import rcdefaults
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from matplotlib.transforms import Bbox

from talbot.base.style import own_style
from talbot.base.supervise import RUN

# Of a label beside its point: offset in points, alignment
PLACES = ((5, 3, "left", "bottom"), (5, -3, "left", "top"), (-5, 3, "right", "bottom"), (-5, -3, "right", "top"))
PLACES += ((0, 7, "center", "bottom"), (0, -7, "center", "top"))
BROAD = 8  # inches: a chart of this width has a row of a page for itself
# How a series is drawn, unless its points are in an order and joined
SCATTER: dict[str, Any] = {"linestyle": "none"}
LINE: dict[str, Any] = {"marker": "", "linewidth": 1.6}
COLOURS = ("#4878a8", "#e8a33d", "#7aa874", "#b8678f", "#8a8f99", "#c9574b")


if os.environ.get(RUN):  # in a notebook or a program of the user's they stay as they are
    rcdefaults()  # a matplotlibrc in the working folder has been read already


@own_style()
def svg(figure: Figure) -> Markup:
    """SVG of a figure, for a page: black is the page's ink, white its paper; `described` in words."""
    canvas, out = FigureCanvasSVG(figure), io.StringIO()
    if figure.get_layout_engine():  # fills its canvas; savefig would draw it twice
        for patch in (figure.patch, *(axes.patch for axes in figure.axes)):
            patch.set_facecolor("none")
        canvas.print_svg(out, metadata={"Date": None})
    else:
        figure.savefig(out, format="svg", bbox_inches="tight", transparent=True, metadata={"Date": None})
    text = out.getvalue().replace("#000000", "currentColor")
    kind = 'class="broad" ' if figure.get_figwidth() >= BROAD else ""
    kind += f'role="img" aria-label="{escape(described(figure))}"'
    return Markup(re.sub(r'width="[\d.]+pt" height="[\d.]+pt"', lambda _: kind, text[text.index("<svg") :], count=1))


@own_style()
def described(figure: Figure) -> str:
    """Return a description of a figure: titles, axes and series of each part."""
    parts = []
    for axes in figure.axes:
        title = next((text for where in ("left", "center", "right") if (text := axes.get_title(where))), "")
        against = " against ".join(text for text in (axes.get_ylabel(), axes.get_xlabel()) if text)
        ticks = [tick.get_text() for tick in axes.get_yticklabels()][::-1] if axes.containers else []
        series = [str(label) for label in axes.get_legend_handles_labels()[1]]
        parts.append("; ".join(text for text in (title, against, ", ".join(filter(None, ticks + series))) if text))
    return " ".join(". ".join(part for part in parts if part).split()) or "chart"


def save(figure: Figure, path: Path | BinaryIO) -> None:
    """Write a figure as a PNG to a path or an open file."""
    FigureCanvasAgg(figure)
    figure.savefig(path, format="png", dpi=130, bbox_inches="tight")


def bars(parts: Mapping[str, float], unit: str, title: str) -> Figure:
    """Draw horizontal bars, one for each of ``parts`` (name -> value), with value and share."""
    total = sum(parts.values())
    figure = Figure(figsize=(4.6, 0.42 * len(parts) + 0.7))
    axes = figure.add_subplot()
    names = list(parts)[::-1]
    axes.barh(names, [parts[n] for n in names], color=[COLOURS[i % len(COLOURS)] for i in range(len(names))][::-1])
    for i, name in enumerate(names):
        share = f"  ({100 * parts[name] / total:.0f} %)" if total else ""
        text = f"{parts[name]:,.0f}" if parts[name] >= 1000 else f"{parts[name]:.4g}"
        axes.text(parts[name], i, f" {text} {unit}{share}", va="center", fontsize=8)
    axes.set_xlim(0, 1.55 * max(parts.values(), default=1) or 1)
    _titled(axes, title)
    axes.xaxis.set_visible(False)
    for side in ("top", "right", "bottom"):
        axes.spines[side].set_visible(False)
    axes.tick_params(labelsize=9)
    return figure


def curves(
    series: Mapping[str, Sequence[tuple[float, float, str]]],
    x_label: str,
    y_label: str,
    title: str,
    log_x: bool = False,
    log_y: bool = False,
    mark: tuple[float, float] | None = None,
    styles: Mapping[str, Mapping[str, Any]] = MappingProxyType({}),
) -> Figure:
    """Draw lines with markers. series: name -> points (x, y, label or ''); mark: one (x, y) to circle.

    styles: of series by name, `SCATTER` or `LINE`. A label that has no place next to its point is left out.
    """
    legend_rows = -(-len(series) // 2) if len(series) > 1 else 0
    figure = Figure(figsize=(4.6, 3.2 + 0.18 * legend_rows), layout="constrained")
    axes = figure.add_subplot()
    for i, (name, points) in enumerate(series.items()):
        x, y = ([point[k] for point in points] for k in (0, 1))
        marker, linestyle = ("o", "-") if i < len(COLOURS) else ("s", "--")
        look = {"marker": marker, "linestyle": linestyle, "linewidth": 1.2} | dict(styles.get(name, {}))
        axes.plot(x, y, color=COLOURS[i % len(COLOURS)], label=name, markersize=4, **look)
    if mark:
        axes.plot(*mark, "o", markersize=12, fillstyle="none", color="#c9574b")
    for axis, scale, log in ((axes.xaxis, axes.set_xscale, log_x), (axes.yaxis, axes.set_yscale, log_y)):
        if log:
            scale("log")
            values = [y if axis is axes.yaxis else x for points in series.values() for x, y, _ in points]
            if values and max(values) < 300 * min(values):
                axis.set_major_locator(LogLocator(subs=(1, 2, 5), numticks=12))
                axis.set_major_formatter(FuncFormatter(_number))
            axis.set_minor_locator(NullLocator())
    axes.margins(0.09)
    axes.set_xlabel(x_label, fontsize=9)
    axes.set_ylabel(y_label, fontsize=9)
    _titled(axes, title)
    axes.grid(alpha=0.25)
    axes.tick_params(labelsize=8)
    if len(series) > 1:
        figure.legend(fontsize=8, frameon=False, loc="outside lower left", ncols=2)
    place_labels(axes, [point for points in series.values() for point in points])
    return figure


def front(points: Iterable[tuple[float, float, str]]) -> list[tuple[float, float, str]]:
    """Corners of the staircase over the non-dominated ``points``, by ascending x; large is good in both."""
    best: list[tuple[float, float, str]] = []
    for x, y, _ in sorted(points, reverse=True):
        if not best:
            best.append((x, y, ""))
        elif y > best[-1][1]:
            best += [(x, best[-1][1], ""), (x, y, "")]
    return best[::-1]


def place_labels(axes: Axes, points: Sequence[tuple[float, float, str]]) -> None:
    """Write the labels of ``points`` (x, y, label or '') next to them, over no other label, point or line."""
    if not any(label for _, _, label in points):
        return
    figure = axes.figure
    canvas = FigureCanvasAgg(figure)  # pyright: ignore[reportArgumentType]
    canvas.draw()  # the layout is that of the finished figure
    at = axes.transData.transform([point[:2] for point in points]) if points else []
    taken = [Bbox.from_extents(x - 3, y - 3, x + 3, y + 3) for x, y in at]
    for line in axes.lines:
        ends = axes.transData.transform(np.column_stack(line.get_data(orig=False)).astype(float))
        for start, end in pairwise(ends[np.isfinite(ends).all(1)] if line.get_linestyle() != "None" else ()):
            steps = np.linspace(start, end, 2 + int(np.hypot(*(end - start)) // 3))
            taken += [Bbox.from_extents(x - 1, y - 1, x + 1, y + 1) for x, y in steps]
    inside = axes.get_window_extent()
    for (x, y, label), own in zip(points, taken[: len(points)], strict=True):
        for dx, dy, across, up in PLACES if label else ():
            text = axes.annotate(
                label, (x, y), (dx, dy), textcoords="offset points", fontsize=7, ha=across, va=up, in_layout=False
            )
            box = text.get_window_extent(canvas.get_renderer())
            free = inside.x0 <= box.x0 and box.x1 <= inside.x1 and inside.y0 <= box.y0 and box.y1 <= inside.y1
            if free and not any(box.overlaps(other) for other in taken if other is not own):
                taken.append(box)
                break
            text.remove()


def _number(value: float, _: object) -> str:
    return f"{value:,.0f}" if 1000 <= value < 1e7 else f"{value:g}"


def _titled(axes: Axes, title: str) -> None:
    axes.set_title(textwrap.fill(title, 52), fontsize=10, loc="left")
