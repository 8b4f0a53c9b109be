"""Labels of a streamed layout: the design's names on the layers that the process's decks read."""

from collections.abc import Collection, Iterable, Sequence

from talbot.base.gds import db
from talbot.base.steps import StepError
from talbot.platforms.coriolis import CoriolisPlatform

from ..netlist.netlist import SUPPLIES


def relabel(
    layout: "db.Layout", ports: Collection[str], tech: CoriolisPlatform, supplies: Sequence[str] = SUPPLIES
) -> None:
    """Put the labels of ``ports`` on the layers that decks read; drop all others, and Coriolis's blockages.

    supplies: their new names. Of a port's labels that nearest to the west or the east edge stays, and all of the
    supplies. Raises StepError when a port has no label.
    """
    top = layout.top_cell()
    found, edges = {}, top.bbox()
    for metal in tech.metals:
        label = layout.layer(*metal.label)
        pin = layout.layer(*metal.pin)
        texts = top.shapes(layout.layer(metal.layer, 0))
        labels = list(texts.each(db.Shapes.STexts))
        for shape in labels:
            net = shape.text.string
            if net in ports:
                from_edge = min(shape.text.x - edges.left, edges.right - shape.text.x)
                found.setdefault(net, []).append((from_edge, (label, pin), shape.text.trans))
        for shape in labels:
            shape.delete()
        if metal.datatype:  # else it is where the metal itself is
            texts.clear()
    if lacking := sorted(set(ports) - set(found)):
        raise StepError(f"stream_out: ports without a pin in the layout: {', '.join(lacking[:5])}")
    called = dict(zip(SUPPLIES, supplies, strict=True))
    kept = {layout.layer(*metal.pin): [] for metal in tech.metals}
    for net, texts in found.items():
        for _, layers, place in texts if net in SUPPLIES else [min(texts, key=lambda text: text[0])]:
            kept[layers[-1]].append(place.disp)
            for layer in layers:
                top.shapes(layer).insert(db.Text(called.get(net, net), place))
    for layer, places in kept.items():
        _clear_pins(top.shapes(layer), places)
    for info in [info for info in layout.layer_infos() if info.layer == tech.blockage_layer]:
        layout.clear_layer(layout.layer(info))


def _clear_pins(shapes: "db.Shapes", places: Iterable["db.Vector"]) -> None:
    """Leave of the boxes ``shapes`` of a pins' layer, for each of ``places``, the smallest one around it.

    Coriolis marks all segments of a port's net as pins; decks take a pin for metal.
    """
    boxes = [shape.bbox() for shape in shapes.each(db.Shapes.SAll - db.Shapes.STexts)]
    for shape in list(shapes.each(db.Shapes.SAll - db.Shapes.STexts)):
        shape.delete()
    for place in places:
        if around := [box for box in boxes if box.contains(db.Point() + place)]:
            shapes.insert(min(around, key=db.Box.area))
