"""The ports of a block: pieces of metal at its edge, inside of it, above all that cells use."""

from collections.abc import Iterable, Sequence
from typing import Any

from base.gds import db
from platforms.coriolis import CoriolisPlatform

from ..geometry.boxes import Box
from .rules import RoutingRules

LEVELS = {"west": 3, "east": 3, "south": 2, "north": 2}  # of the metals, from that of the cells' pins up
Port = tuple[str, str, float]  # side, net, offset in um along the side


def draw_ports(
    layout: "db.Layout", ports: Sequence[Port], replaced: Iterable[Sequence[Any]],
    rules: RoutingRules, tech: CoriolisPlatform,
) -> dict[str, list[Any]]:  # fmt: skip
    """Draw ``ports`` with their texts in place of all texts and ``replaced``, [layer, left, bottom, right, top] in um.

    By net the box of its port, in the same form.
    """
    top, made = layout.top_cell(), {}
    edges = top.bbox()
    numbers = {metal.name: metal.layer for metal in tech.metals}
    old = {(numbers[name], *(round(1000 * value) for value in um)) for name, *um in replaced}
    for index in layout.layer_indexes():
        number = layout.get_info(index).layer
        for shape in list(top.shapes(index).each()):
            box = shape.bbox()
            if shape.is_text() or (number, box.left, box.bottom, box.right, box.top) in old:
                shape.delete()
    for side, net, offset in ports:
        level = min(LEVELS[side], len(tech.metals) - 1)
        metal, box = tech.metals[level], _box(side, round(1000 * offset), edges, rules, level)
        for at in (metal.gds, metal.pin):
            top.shapes(layout.layer(*at)).insert(db.Box(*box))
        middle = db.Trans((box[0] + box[2]) // 2, (box[1] + box[3]) // 2)
        top.shapes(layout.layer(metal.layer, 0)).insert(db.Text(net, middle))
        made[net] = [metal.name, *(value / 1000 for value in box)]
    return made


def label_straps(layout: "db.Layout", straps: Iterable[tuple[str, float, Any]], tech: CoriolisPlatform) -> None:
    """Write the supplies' names on all ``straps``, (supply, x in um, gaps), in their middles."""
    top, metal = layout.top_cell(), tech.metals[-1]
    shapes, metals = top.shapes(layout.layer(metal.layer, 0)), top.shapes(layout.layer(*metal.gds))
    for net, x, _ in straps:
        column = db.Box(round(1000 * x), top.bbox().bottom, round(1000 * x), top.bbox().top)
        longest = max((shape.bbox() for shape in metals.each_touching(column)), key=db.Box.height)
        shapes.insert(db.Text(net, db.Trans(column.left, longest.center().y)))


def _box(side: str, at: int, edges: "db.Box", rules: RoutingRules, level: int) -> Box:
    """The box (nm) of a port ``at`` along a side: as long as the least area requires, and a track."""
    layer = rules.layers[level]
    half = layer.width // 2
    length = max(-(-layer.area // (2 * half) // 10) * 10, 2 * max(rules.step))
    if side in ("west", "east"):
        left = edges.left if side == "west" else edges.right - length
        return left, at - half, left + length, at + half
    bottom = edges.bottom if side == "south" else edges.top - length
    return at - half, bottom, at + half, bottom + length
