"""The die as a picture: its blocks, routes, bars and pads."""

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from talbot.base.style import own_style
from talbot.flow.layout.sensor.package import signal
from talbot.flow.layout.sensor.plan import BLOCKS, CORE

COLORS = dict(zip((*BLOCKS, CORE), ("#7fb3d5", "#f5b041", "#82c99a", "#c39bd3", "#e6837a"), strict=True))


@own_style()
def by_block(png: Path, plan: dict[str, Any], black_boxes: Collection[str]) -> None:
    """Draw the plan of the step `die_plan`, black boxes hatched."""
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    figure = Figure(figsize=(9, 9), layout="constrained")
    axes = figure.subplots()
    for net, _, _, *box in plan["shapes"]:
        if net not in plan["routes"] and min(box[2] - box[0], box[3] - box[1]) > 2000:
            left, bottom, right, top = (size / 1e3 for size in box)
            color = "0.75" if net in ("vss", "vssa") else "0.55"
            axes.add_patch(Rectangle((left, bottom), right - left, top - bottom, facecolor=color, linewidth=0))
    for place in plan["ring"]:
        left, bottom, right, top = (size / 1e3 for size in place["box"])
        color = "#d5c7a3" if place["nets"] else "#ece6d8"
        style = {"facecolor": color, "edgecolor": "0.5", "linewidth": 0.3 if place["nets"] else 0}
        axes.add_patch(Rectangle((left, bottom), right - left, top - bottom, **style))
        if place["nets"]:
            flat = place["side"] in ("west", "east")
            name, style = signal(place["name"]), {"ha": "center", "va": "center", "fontsize": 4}
            axes.annotate(name, ((left + right) / 2, (bottom + top) / 2), rotation=0 if flat else 90, **style)
    for name, block in plan["blocks"].items():
        left, bottom, right, top = (size / 1e3 for size in block["box"])
        width, height, hatch = right - left, top - bottom, "//" if name in black_boxes else None
        style = {"facecolor": COLORS[name], "alpha": 0.85, "edgecolor": "0.3", "hatch": hatch, "linewidth": 0.6}
        axes.add_patch(Rectangle((left, bottom), width, height, **style))
        label = f"{'digital chip' if name == CORE else name.replace('_', ' ')}\n{width:.0f} × {height:.0f} µm"
        style = {"ha": "center", "va": "center", "fontsize": 8, "rotation": 90 if height > 3 * width else 0}
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8}
        axes.annotate(label, ((left + right) / 2, (bottom + top) / 2), bbox=box, **style)
    lines = [line for route in plan["routes"].values() for line in _lines(route)]
    axes.add_collection(LineCollection(lines, colors="#17202a", linewidths=0.25))
    axes.set(xlim=(0, plan["die"][0] / 1e3), ylim=(0, plan["die"][1] / 1e3), aspect="equal", xlabel="µm", ylabel="µm")
    figure.savefig(png, dpi=220, metadata={"Software": None})


def _lines(route: Mapping[str, Any]) -> Iterator[tuple[tuple[float, float], tuple[float, float]]]:
    """Pairs of ends, um, of a route's trunk and branches."""
    y, xs = route["y"] / 1e3, [branch["x"] / 1e3 for branch in route["branches"]]
    yield (min(xs), y), (max(xs), y)
    for branch, x in zip(route["branches"], xs, strict=True):
        yield (x, y), (x, branch["end"] / 1e3)
