"""Heat maps and curves as pictures inside the page."""

import base64
import io

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

SCALE = 15  # per cent at the ends of the colours


def embedded(figure):
    """The figure as the text of an <img src>."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=80)
    plt.close(figure)
    return "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode()


def heat_maps(differences):
    """One row of maps: relative error in per cent of every two-dimensional table of one cell, grid by grid."""
    tables = [d for d in differences if np.ndim(d.theirs) == 2 and np.isfinite(d.ours - d.theirs).all()]
    columns = 6
    rows = max(1, -(-len(tables) // columns))
    figure, axes = plt.subplots(rows, columns, figsize=(2.3 * columns, 2.2 * rows), squeeze=False, layout="constrained")
    for axis in axes.flat:
        axis.axis("off")
    for axis, d in zip(axes.flat, tables, strict=False):
        time = d.kind in ("setup", "hold", "recovery", "removal")
        values = (d.ours - d.theirs) * 1e3 if time else 100 * d.relative
        axis.imshow(values, cmap="RdBu_r", vmin=-SCALE, vmax=SCALE)
        for (i, j), value in np.ndenumerate(values):
            axis.text(
                j,
                i,
                str(round(value)),
                ha="center",
                va="center",
                fontsize=6,
                color="white" if abs(value) > 0.7 * SCALE else "black",
            )
        axis.set_title(f"{d.what}{' (ps)' if time else ' (%)'}", fontsize=6)
    return embedded(figure)


def error_against_time(rows, default):
    """Seconds against the median and the 95th percentile of the error; points have their numbers in ``rows``."""
    figure, axis = plt.subplots(figsize=(9, 5), layout="constrained")
    for number, (name, seconds, median, high) in enumerate(rows, start=1):
        grid = name.startswith("grid")
        axis.plot([seconds, seconds], [median, high], "-", color="0.8", zorder=1)
        axis.plot(seconds, median, "s" if grid else "o", color="C0")
        axis.plot(seconds, high, "s" if grid else "o", color="C3", mfc="none")
        weight = "bold" if name == default else "normal"
        axis.annotate(
            str(number), (seconds, high), fontsize=8, weight=weight, xytext=(2, 3), textcoords="offset points"
        )
    axis.set(
        xscale="log",
        yscale="log",
        xlabel="seconds of the processor, three cells",
        ylabel="error in per cent: median, 95th percentile",
    )
    axis.grid(alpha=0.3, which="both")
    return embedded(figure)
