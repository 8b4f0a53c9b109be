"""Connectivity of a GDS: the pins that its metal connects, and how that differs from the nets."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from talbot.flow.layout.sensor.plan import Terminal
from talbot.platforms.die import TopMetal
from talbot.platforms.layers import GdsLayer
from talbot.platforms.layout import LayoutPlatform

if TYPE_CHECKING:
    import klayout.db as kdb


Nets = dict[str, list[Terminal]]
Ring = Mapping[tuple[str, int, int], str]


def nets(
    gds: Path, cells: Mapping[str, str], ring: "Ring", tech: LayoutPlatform, top_metal: TopMetal, plate: GdsLayer
) -> list[set[Terminal]]:
    """Terminals that each net of the top cell connects.

    cells: cell -> block. ring: (cell, x, y) -> pad. In both, '' is a cell that only continues nets, as fillers do. A
    pin of a block is named by its text on the pin layer in the block's own cell, one of the die ('die') by that in the
    top cell; metal of a block without a name is ('block', '?...'). plate: of capacitors, which the highest via of
    ``tech`` meets in place of the metal below. KLayout extracts the metals and vias of all cells, without transistors.
    """
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(gds))
    (top,) = layout.top_cells()
    l2n = db.LayoutToNetlist(db.RecursiveShapeIterator(layout, top, []))
    metals = []
    for metal in (*tech.metals, top_metal.metal):
        metals.append(l2n.make_polygon_layer(layout.layer(metal.layer, metal.datatype), metal.name))
        names = l2n.make_text_layer(layout.layer(metal.layer, tech.pin_datatype), f"{metal.name}_pin")
        l2n.connect(metals[-1])
        l2n.connect(metals[-1], names)
    for level, via in enumerate((*tech.vias, top_metal.via)):
        between = l2n.make_polygon_layer(layout.layer(via.layer, via.datatype), via.name)
        if via is tech.vias[-1]:
            plates = l2n.make_polygon_layer(layout.layer(*plate), "plate")
            on_plates, between = between & plates, between - plates
            for joined in (plates, on_plates):
                l2n.connect(joined)
            l2n.connect(plates, on_plates)
            l2n.connect(on_plates, metals[level + 1])
        l2n.connect(between)
        l2n.connect(metals[level], between)
        l2n.connect(between, metals[level + 1])
    l2n.extract_netlist()
    circuit = l2n.netlist().circuit_by_name(top.name)
    return [found for net in circuit.each_net() if (found := _terminals(net, cells, ring))]


def _terminals(net: "kdb.Net", cells: Mapping[str, str], ring: "Ring") -> set[Terminal]:
    found = {("die", name) for name in net.name.split(",") if name}
    for reference in net.each_subcircuit_pin():
        subcircuit = reference.subcircuit()
        circuit, at = subcircuit.circuit_ref(), subcircuit.trans.disp
        block = ring.get((circuit.name, round(1000 * at.x), round(1000 * at.y)), cells.get(circuit.name, circuit.name))
        if not block:
            continue
        inner = circuit.net_for_pin(reference.pin_id())
        for pin in (inner.name or f"?{inner.expanded_name()}").split(","):
            found.add((block, pin))
    return found


def compare(found: Sequence[set[Terminal]], wanted: Mapping[str, Sequence[Sequence[str]]]) -> tuple[Nets, Nets]:
    """Opens (net -> its terminals that are not on its largest part) and shorts ('net, net' -> terminals connected).

    found: of `nets`. wanted: terminals of each net. A terminal of no net is a net of its own.
    """
    of = {(block, pin): net for net, ends in wanted.items() for block, pin in ends}
    parts: dict[str, list[set[Terminal]]] = {}
    shorts = {}
    for ends in found:
        here: dict[str, list[Terminal]] = {}
        for end in ends:
            here.setdefault(of.get(end, " ".join(end)), []).append(end)
        if len(here) > 1:
            shorts[", ".join(sorted(here))] = sorted(ends)
        for net, own in here.items():
            parts.setdefault(net, []).append(set(own))
    opens = {}
    for net, ends in wanted.items():
        lacking = {(block, pin) for block, pin in ends} - max(parts.get(net, [set()]), key=len)
        if lacking or len(parts.get(net, ())) > 1:
            opens[net] = sorted(lacking)
    return opens, shorts
