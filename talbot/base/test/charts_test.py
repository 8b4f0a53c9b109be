"""Charts: labels over nothing else and inside the axes; colours of a page."""

import re
from itertools import combinations

import numpy as np
from matplotlib import rc_context, rcParams
from matplotlib.backends.backend_agg import FigureCanvasAgg

from talbot.base.charts import LINE, SCATTER, bars, curves, front, svg
from talbot.base.style import own_style

CROWDED = [(1 + 0.02 * i, 5 + 0.05 * i, f"T={i}") for i in range(60)]


def labels(figure):
    """Extents of the labels that were placed, of the axes, and the points in pixels."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    (axes,) = figure.axes
    found = [text.get_window_extent(canvas.get_renderer()) for text in axes.texts]
    return found, axes.get_window_extent(), axes.transData.transform([point[:2] for point in CROWDED])


def test_labels_collide_with_nothing():
    found, inside, points = labels(curves({"a": CROWDED}, "x", "y", "crowded"))
    assert 5 < len(found) < len(CROWDED)
    assert not any(a.overlaps(b) for a, b in combinations(found, 2))
    assert not any(box.contains(*point) for box in found for point in points)
    assert all(inside.x0 <= box.x0 and box.x1 <= inside.x1 for box in found)


def test_labels_that_have_room_are_all_there():
    few = [(10.0**i, 10.0**-i, str(i)) for i in range(4)]
    figure = curves({"a": few, "b": []}, "x", "y", "few", log_x=True, log_y=True)
    assert [text.get_text() for text in figure.axes[0].texts] == ["0", "1", "2", "3"]


def test_ticks_of_a_short_logarithmic_axis_are_plain_numbers():
    figure = curves({"a": [(900, 1, ""), (70000, 2, "")]}, "x", "y", "t", log_x=True)
    FigureCanvasAgg(figure).draw()
    shown = {tick.get_text() for tick in figure.axes[0].get_xticklabels()}
    assert {"1,000", "2,000", "5,000", "50,000"} <= shown


def test_black_is_the_ink_of_the_page():
    text = svg(bars({"one": 1.0, "two": np.float64(3000)}, "cycles", "a title"))
    assert text.startswith("<svg") and "currentColor" in text and "#000000" not in text and "#ffffff" not in text


def test_points_without_an_order_are_not_joined():
    points = {"measured": [(2, 3, ""), (1, 5, ""), (3, 1, "")], "fitted": [(1, 5, ""), (3, 1, "")]}
    figure = curves(points, "x", "y", "t", styles={"measured": SCATTER, "fitted": LINE})
    drawn = {line.get_label(): (line.get_linestyle(), line.get_marker()) for line in figure.axes[0].lines}
    assert drawn == {"measured": ("None", "o"), "fitted": ("-", "")}


def test_a_front_is_a_staircase_of_the_points_that_nothing_dominates():
    points = [(2, 3, "b"), (1, 5, "a"), (1, 4, ""), (3, 1, ""), (2, 2, ""), (3, 1, "")]
    assert [corner[:2] for corner in front(points)] == [(1, 5), (1, 3), (2, 3), (2, 1), (3, 1)]
    assert front([]) == []


def test_a_users_settings_of_matplotlib_change_no_chart():
    plain = svg(bars({"a": 1.0, "b": 3.0}, "um", "t"))
    with rc_context({"text.usetex": True, "lines.linewidth": 9, "font.size": 30, "svg.fonttype": "none"}):
        with own_style():
            figure = bars({"a": 1.0, "b": 3.0}, "um", "t")
        text = svg(figure)
        assert rcParams["text.usetex"] and rcParams["font.size"] == 30

    def without_names(text):  # of clip paths, which are random
        return re.sub(r"[a-z]?[0-9a-f]{10}", "", text)

    assert without_names(text) == without_names(plain)
