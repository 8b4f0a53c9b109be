"""The ports of a block: metal at its edge, inside of it, above all that cells use, or where a frame has them."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from talbot.base.gds import db
from talbot.platforms.coriolis import CoriolisPlatform

from ..geometry.boxes import Box
from .rules import RoutingRules

LEVELS = {"west": 3, "east": 3, "south": 2, "north": 2}  # of the metals, from that of the cells' pins up
Place = tuple[str, str, float]  # side, net, offset in um along the side
Port = tuple[str, str, Sequence[float]]  # net, metal, box in um


def edge_ports(places: Iterable[Place], edges: "db.Box", rules: RoutingRules, tech: CoriolisPlatform) -> Iterator[Port]:
    """Ports at ``places`` of the sides of the box ``edges`` (nm)."""
    for side, net, offset in places:
        level = min(LEVELS[side], len(tech.metals) - 1)
        box = _box(side, round(1000 * offset), edges, rules, level)
        yield net, tech.metals[level].name, [value / 1000 for value in box]


def draw_ports(
    layout: "db.Layout", ports: Iterable[Port], replaced: Iterable[Sequence[Any]], tech: CoriolisPlatform
) -> dict[str, list[Any]]:
    """Draw ``ports`` with their texts in place of all texts and ``replaced``, [layer, left, bottom, right, top] in um.

    By net the box of its port, in the same form.
    """
    top, made, metals = layout.top_cell(), {}, {metal.name: metal for metal in tech.metals}
    old = {(metals[name].layer, *(round(1000 * value) for value in um)) for name, *um in replaced}
    for index in layout.layer_indexes():
        number = layout.get_info(index).layer
        for shape in list(top.shapes(index).each()):
            box = shape.bbox()
            if shape.is_text() or (number, box.left, box.bottom, box.right, box.top) in old:
                shape.delete()
    for net, name, um in ports:
        metal, box = metals[name], db.DBox(*um).to_itype(layout.dbu)
        for at in (metal.gds, metal.pin):
            top.shapes(layout.layer(*at)).insert(box)
        top.shapes(layout.layer(metal.layer, 0)).insert(db.Text(net, db.Trans(box.center() - db.Point())))
        made[net] = [name, *um]
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
