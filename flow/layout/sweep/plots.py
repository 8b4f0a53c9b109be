"""The sweep as a figure."""

from collections.abc import Iterable, Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter

from talbot.base.charts import COLOURS

Point = dict[str, Any]  # of points.py, for JSON


def front(points: Iterable[Point], small: str, large: str) -> list[Point]:
    """The Pareto front, sorted by ``small``: no other point has a smaller ``small`` and a larger ``large``."""

    def beats(q: Point, p: Point) -> bool:
        return q[small] <= p[small] and q[large] >= p[large] and (q[small], q[large]) != (p[small], p[large])

    best = [p for p in points if not any(beats(q, p) for q in points)]
    return sorted(best, key=lambda p: p[small])


def pareto_plot(points: Sequence[Point]) -> Figure:
    """Plot area against highest clock, and area against energy a result; the Pareto front of each as a line."""
    points = [point for point in points if point["closed"]]
    figure = Figure(figsize=(11, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    colour = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(dict.fromkeys(p["variant"] for p in points))}
    counted = [dict(point, results_uj=1e6 / point["pj_result"]) for point in points if point["pj_result"]]
    for axes, shown, key in ((left, points, "f_max_mhz"), (right, counted, "pj_result")):
        for name in colour:
            mine = [point for point in shown if point["variant"] == name]
            axes.plot([p["area_um2"] for p in mine], [p[key] for p in mine], "o", color=colour[name], label=name)
        for point in shown:
            at = point["area_um2"], point[key]
            axes.annotate(point["bits"], at, fontsize=8, xytext=(5, 3), textcoords="offset points")
        line = front(shown, "area_um2", "f_max_mhz" if axes is left else "results_uj")
        corners = [p["area_um2"] for p in line], [p[key] for p in line]
        axes.plot(*corners, color="0.6", linewidth=1, zorder=0, drawstyle="steps-post")
        axes.set_xlabel("routed area, um2")
        axes.margins(0.08)
    left.set(ylabel="highest clock at the slowest corner, MHz")
    left.legend(title="beside a mark: fraction bits", fontsize=9, title_fontsize=9, frameon=False)
    right.set(ylabel="energy a result in a real frame, pJ", yscale="log")
    right.yaxis.set_minor_formatter(LogFormatter(labelOnlyBase=False, minor_thresholds=(3, 1)))
    return figure
