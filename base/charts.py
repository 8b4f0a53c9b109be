"""Charts (Matplotlib, no display): `bars` and `curves` make a figure, `svg` and `save` put it out."""

import io
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import BinaryIO

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

COLOURS = ("#4878a8", "#e8a33d", "#7aa874", "#b8678f", "#8a8f99", "#c9574b")


def svg(figure: Figure) -> str:
    """SVG text of a figure, for a page."""
    FigureCanvasSVG(figure)
    out = io.StringIO()
    figure.savefig(out, format="svg", bbox_inches="tight", metadata={"Date": None})
    text = out.getvalue()
    return re.sub(r'width="[\d.]+pt" height="[\d.]+pt"', "", text[text.index("<svg") :], count=1)


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
    axes.set_title(title, fontsize=10, loc="left")
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
) -> Figure:
    """Draw lines with markers. series: name -> points (x, y, label or ''); mark: one (x, y) to circle."""
    figure = Figure(figsize=(4.6, 3.1))
    axes = figure.add_subplot()
    for i, (name, points) in enumerate(series.items()):
        axes.plot(
            [p[0] for p in points],
            [p[1] for p in points],
            "o-",
            color=COLOURS[i % len(COLOURS)],
            label=name,
            markersize=4,
        )
        for x, y, label in points:
            if label:
                axes.annotate(label, (x, y), textcoords="offset points", xytext=(4, 4), fontsize=7)
    if mark:
        axes.plot(*mark, "o", markersize=12, fillstyle="none", color="#c9574b")
    if log_x:
        axes.set_xscale("log")
    if log_y:
        axes.set_yscale("log")
    if len(series) > 1:
        axes.legend(fontsize=8, frameon=False)
    axes.set_xlabel(x_label, fontsize=9)
    axes.set_ylabel(y_label, fontsize=9)
    axes.set_title(title, fontsize=10, loc="left")
    axes.grid(alpha=0.25)
    axes.tick_params(labelsize=8)
    return figure
