"""The design rules that routing can break, checked while a cell is made; the decks check all of them at the end."""

from collections.abc import Mapping

from talbot.base.gds import db
from talbot.cells.compact.draw import Drawing, Shape, regions

SPACES = {"li": 170, "poly": 210, "m1": 140, "difftap": 270, "licon": 170, "mcon": 190}  # nm
WIDTHS = {"li": 170, "poly": 150, "m1": 140, "difftap": 150}
AREAS = {"li": 56_100, "m1": 83_000}  # nm2
ACCESS = (160, 145)  # nm, half of what a route needs on met1 over a pin: the pads of a via down and of one up


def broken(drawing: Drawing) -> list[str]:
    """The names of the rules that a drawing breaks."""
    by_layer = regions(drawing.shapes)
    whole = {layer: region.merged() for layer, region in by_layer.items()}
    out = [f"{layer} space" for layer, space in SPACES.items() if not whole[layer].space_check(space).is_empty()]
    out += [f"{layer} width" for layer, width in WIDTHS.items() if not whole[layer].width_check(width).is_empty()]
    out += [f"{layer} area" for layer, area in AREAS.items() if not whole[layer].with_area(0, area, False).is_empty()]
    nets = {}
    for s in drawing.shapes:
        if s.net:
            nets.setdefault((s.layer, s.net), db.Region()).insert(s.nm)
    for layer in ("li", "poly", "m1"):
        parts = [(net, region.merged()) for (name, net), region in nets.items() if name == layer]
        for i, (a, first) in enumerate(parts):
            out += [f"{layer} short of {a} and {b}" for b, second in parts[i + 1 :] if not (first & second).is_empty()]
    if not ((whole["licon"] & whole["poly"]).sized(190) & whole["difftap"]).is_empty():
        out.append("licon on poly to difftap")
    pins, step = [s for s in drawing.shapes if s.layer == "li.pin"], round(drawing.canvas.site * 500)
    out += [f"{pin.net} out of reach" for pin in pins if not reachable(pin, nets, step)]
    return out


def reachable(pin: Shape, nets: "Mapping[tuple[str, str], db.Region]", step: int) -> bool:
    """Whether a route on met1 has room over a ``pin`` on li.

    nets: the cell's shapes by layer and net. step: half a track, at whose multiples a route can meet a pin, nm.
    """
    others = db.Region()
    for (layer, net), region in nets.items():
        if layer == "m1" and net != pin.net:
            others += region
    reach, box = [half + SPACES["m1"] - 1 for half in ACCESS], pin.nm
    x, inset = box.center().x, WIDTHS["li"] // 2
    places = range(-(-(box.bottom + inset) // step), (box.top - inset) // step + 1)
    around = (db.Box(x - reach[0], k * step - reach[1], x + reach[0], k * step + reach[1]) for k in places)
    return any((others & db.Region(room)).is_empty() for room in around)
