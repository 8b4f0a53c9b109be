"""Heat maps and curves as pictures inside the page."""

import base64
import io
from collections.abc import Sequence

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from talbot.cells.liberty.compare import Difference
from talbot.cells.report.curve import Setting

SCALE = 15  # per cent at the ends of the colours


def embedded(figure: Figure) -> str:
    """The figure as the text of an <img src>."""
    FigureCanvasAgg(figure)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=80)
    return "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode()


def heat_maps(differences: Sequence[Difference]) -> str:
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
    return embedded(figure)


def error_against_time(rows: Sequence[Setting], default: str) -> str:
    """Draw the error against CPU seconds: median and 95th percentile; points have their numbers in ``rows``."""
    axis = (figure := Figure(figsize=(9, 5), layout="constrained")).subplots()
    for number, (name, seconds, median, high) in enumerate(rows, start=1):
        marker = "s" if name.startswith("grid") else "o"
        axis.plot([seconds, seconds], [median, high], "-", color="0.8", zorder=1)
        axis.plot(seconds, median, marker, color="C0")
        axis.plot(seconds, high, marker, color="C3", mfc="none")
        weight, at = "bold" if name == default else "normal", (seconds, high)
        axis.annotate(str(number), at, fontsize=8, weight=weight, xytext=(2, 3), textcoords="offset points")
    label = "error in per cent: median, 95th percentile"
    axis.set(xscale="log", yscale="log", xlabel="CPU seconds, three cells", ylabel=label)
    axis.grid(alpha=0.3, which="both")
    return embedded(figure)
