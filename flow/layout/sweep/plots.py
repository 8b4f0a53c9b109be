"""The sweeps as figures."""

from collections.abc import Iterable, Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogFormatter

from talbot.base.charts import COLOURS

QUALITY = ("area_um2", "area, um2"), ("wire_um", "wire length, um"), ("wns_ns", "worst setup slack, ns")
MARKS = {1: "o", 3: "s", 6: "^"}
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


def effort_plot(points: Sequence[Point]) -> Figure:
    """Plot seconds of place and route against area, wire length and worst slack.

    A mark an effort, a colour a utilization, the spread as labels; crosses at the bottom did not close.
    """
    figure = Figure(figsize=(13, 4.6), layout="constrained")
    shares = sorted({point["utilization"] for point in points})
    colour = {share: COLOURS[k % len(COLOURS)] for k, share in enumerate(shares)}
    for axes, (key, words) in zip(figure.subplots(1, 3), QUALITY, strict=True):
        for point in points:
            if not point["closed"]:
                bottom = {"transform": axes.get_xaxis_transform(), "clip_on": False}
                axes.plot(point["seconds"], 0, "x", color=colour[point["utilization"]], **bottom)
        for (value, effort, share), same in alike(points, key).items():
            axes.plot([point["seconds"] for point in same], [value] * len(same), MARKS[effort], color=colour[share])
            if key != "area_um2":  # which follows from the utilization
                label, at = ", ".join(f"{point['spread']:g}" for point in same), (same[-1]["seconds"], value)
                axes.annotate(label, at, fontsize=7, xytext=(6, -3), textcoords="offset points")
        axes.set(xlabel="seconds of placement, routing and rerouting", ylabel=words)
        axes.margins(0.08)
    marks = [(mark, "0.5", f"effort {effort}") for effort, mark in MARKS.items()]
    marks += [("o", colour[share], f"utilization {share:g}") for share in shares] + [("x", "0.5", "did not close")]
    handles = [Line2D([], [], linestyle="", marker=mark, color=c, label=label) for mark, c, label in marks]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), fontsize=8, frameon=False)
    return figure


def alike(points: Iterable[Point], key: str) -> dict[tuple[float, int, float], list[Point]]:
    """Group the points that closed by (value of ``key``, effort, utilization), the slowest last."""
    found: dict[tuple[float, int, float], list[Point]] = {}
    for point in sorted(points, key=lambda point: point["seconds"]):
        if point["closed"]:
            found.setdefault((point[key], point["effort"], point["utilization"]), []).append(point)
    return found
