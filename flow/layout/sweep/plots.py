"""The sweeps as figures."""

from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter

from flow.charts import COLOURS


def front(points, small, large):
    """Points that no other beats in both: ``small`` not smaller and ``large`` not larger. Sorted by ``small``."""
    best = [p for p in points if not any(q is not p and q[small] <= p[small] and q[large] >= p[large]
                                         and (q[small], q[large]) != (p[small], p[large]) for q in points)]
    return sorted(best, key=lambda p: p[small])


def pareto_plot(points):
    """Area against highest clock, and area against energy a result; the front of each as a line."""
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
            axes.annotate(point["bits"], (point["area_um2"], point[key]), fontsize=8, xytext=(5, 3),
                          textcoords="offset points")
        line = front(shown, "area_um2", "f_max_mhz" if axes is left else "results_uj")
        axes.plot([p["area_um2"] for p in line], [p[key] for p in line], color="0.6", linewidth=1, zorder=0)
        axes.set_xlabel("routed area, um2")
        axes.margins(0.08)
    left.set(ylabel="highest clock at the slowest corner, MHz")
    left.legend(title="beside a mark: fraction bits", fontsize=9, title_fontsize=9)
    right.set(ylabel="energy a result in a real frame, pJ", yscale="log")
    right.yaxis.set_minor_formatter(LogFormatter(labelOnlyBase=False, minor_thresholds=(3, 1)))
    return figure


def effort_plot(points):
    """Seconds of place and route against wire length and worst slack, a mark a point; crosses did not close."""
    figure = Figure(figsize=(11, 4.4), layout="constrained")
    for axes, key, words in zip(figure.subplots(1, 2), ("wire_um", "wns_ns"), ("wires, um", "worst setup slack, ns"),
                                strict=True):
        for point in points:
            if point.get(key) is None:
                axes.plot(point["seconds"], 0, "x", color=COLOURS[5], transform=axes.get_xaxis_transform(),
                          clip_on=False)
                continue
            axes.plot(point["seconds"], point[key], "os^"[point["effort"] - 1], color=COLOURS[0])
            axes.annotate(f"{point['effort']}, {point['variation']:g}", (point["seconds"], point[key]), fontsize=8,
                          xytext=(4, 4), textcoords="offset points")
        axes.set(xlabel="seconds of place and route", ylabel=words)
    figure.suptitle("effort, variation of density; a cross: not routed", fontsize=10)
    return figure
