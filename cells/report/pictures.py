"""Heat maps and curves as pictures inside the page."""

import io
from collections.abc import Sequence

import numpy as np
from markupsafe import Markup
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from talbot.base.charts import place_labels, svg
from talbot.base.page import Picture
from talbot.cells.liberty.compare import Difference
from talbot.cells.report.curve import Setting

SCALE = 15  # per cent at the ends of the colours


def heat_maps(differences: Sequence[Difference]) -> Picture:
    """Draw the relative error in per cent (of constraints ps) of every two-dimensional table of one cell."""
    tables = [d for d in differences if np.ndim(d.theirs) == 2 and np.isfinite(d.ours - d.theirs).all()]
    columns = 6
    rows = max(1, -(-len(tables) // columns))
    figure = Figure(figsize=(2.3 * columns, 2.2 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, d in zip(axes.flat, tables, strict=False):
        time = d.kind in ("setup", "hold", "recovery", "removal")
        values = (d.ours - d.theirs) * 1e3 if time else 100 * d.relative
        axis.imshow(values, cmap="RdBu_r", vmin=-SCALE, vmax=SCALE)
        for (i, j), value in np.ndenumerate(values):
            color = "white" if abs(value) > 0.7 * SCALE else "black"
            axis.text(j, i, str(round(value)), ha="center", va="center", fontsize=6, color=color)
        axis.set_title(f"{d.what}{' (ps)' if time else ' (%)'}", fontsize=6)
    FigureCanvasAgg(figure)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=80)
    caption = "rows: input slew (of constraints: the clock's); columns: load (the data's slew)"
    return Picture(differences[0].cell if differences else "", "", caption, Image.open(buffer))


def error_against_time(rows: Sequence[Setting], default: str) -> Markup:
    """Draw the error against CPU seconds: median and 95th percentile; points have their numbers in ``rows``."""
    axes = (figure := Figure(figsize=(6, 4), layout="constrained")).subplots()
    points = []
    for number, (name, seconds, median, high) in enumerate(rows, start=1):
        marker = "s" if name.startswith("grid") else "o"
        axes.plot([seconds, seconds], [median, high], "-", color="0.6", zorder=1)
        axes.plot(seconds, median, marker, color="C0")
        axes.plot(seconds, high, marker, color="C3", mfc="none", markersize=11 if name == default else 6)
        points.append((seconds, high, str(number)))
    label = "error in per cent: median, 95th percentile"
    axes.set(xscale="log", yscale="log", xlabel="CPU seconds, three cells", ylabel=label)
    axes.grid(alpha=0.3, which="both")
    place_labels(axes, points)
    return svg(figure)
