"""Antennas: the charge that a wire gathers while it is etched, and the gates that would have to bear it.

When a wire's layer is etched, only what lies below joins it to a gate or to a diffusion. The side walls of that layer
on a net, by the area of the net's gates, must stay under the process's ratio; a diffusion on the net raises it.
"""

import json
from dataclasses import dataclass

from base.steps import Step
from platforms.coriolis import coriolis_platform


@dataclass(frozen=True)
class AntennaParameters:
    """pdk: process."""

    pdk: str = "sky130"


class Antenna(Step):
    """Every layer in turn, on the connections that exist by then."""

    name = "antenna"
    inputs = {"gds": "fill.gds", "platform": "platform"}
    outputs = {"summary": "antenna.json"}
    Parameters = AntennaParameters
    metrics = {"antenna_violations": ""}
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db

        known, layout = self.known(), db.Layout()
        layout.read(str(inputs["gds"]))
        found = {
            known.metals[level].name: sorted({str(polygon.bbox().to_dtype(layout.dbu)) for polygon in bad.each()})
            for level, bad in violations(layout, layout.top_cell(), known).items()
        }
        outputs["summary"].write_text(json.dumps(found, indent=1) + "\n")
        return {"antenna_violations": sum(map(len, found.values()))}

    def known(self):
        """CoriolisPlatform, with the wires that are looked at."""
        return coriolis_platform(self.parameters.pdk)


def connected(layout, top, known, levels):
    """Yields (LayoutToNetlist, gates, diffusions, wires: Regions of known.metals[:level + 1]) of every one of
    ``levels``, all up to that wire joined. What an earlier one told of is gone with the next."""
    import klayout.db as db

    l2n = db.LayoutToNetlist(db.RecursiveShapeIterator(layout, top, []))
    layers = {
        name: l2n.make_polygon_layer(layout.layer(*pair), name)
        for name, pair in (("poly", known.poly), ("active", known.active), ("contact", known.contact))
    }
    gate, diffusion = layers["poly"] & layers["active"], layers["active"] - layers["poly"]
    for name, made in (("gate", gate), ("diffusion", diffusion)):
        l2n.register(made, name)
    for a, b in (("poly", "poly"), ("contact", "contact"), ("poly", "contact")):
        l2n.connect(layers[a], layers[b])
    for a, b in ((gate, gate), (diffusion, diffusion), (layers["poly"], gate), (diffusion, layers["contact"])):
        l2n.connect(a, b)
    below, wires = layers["contact"], []
    for level, wire in enumerate(known.metals):
        wires.append(l2n.make_polygon_layer(layout.layer(*wire.gds), wire.name))
        l2n.connect(wires[-1])
        l2n.connect(below, wires[-1])
        if level in levels:
            l2n.extract_netlist()
            yield l2n, gate, diffusion, list(wires)
            l2n.reset_extracted()
        if level < len(known.vias):
            cut = known.vias[level]
            below = l2n.make_polygon_layer(layout.layer(*cut.gds), cut.name)
            l2n.connect(below)
            l2n.connect(wires[-1], below)


def violations(layout, top, known, levels=None):
    """dict level -> klayout.db.Region, known.metals[level] of the nets on which it is too large for their gates, for
    ``levels``, all without."""
    import klayout.db as db

    found, safe = {}, 1e9  # for what has a diffusion, in the check of what has none
    levels = range(len(known.metals)) if levels is None else levels
    for l2n, gate, diffusion, wires in connected(layout, top, known, levels):
        level = len(wires) - 1
        wire = known.metals[level]
        base, more = wire.antenna_diffusion
        factors = (0.0, wire.thickness_um) if known.antenna_walls else (1.0, 0.0)  # of the metal's area, its edges
        bad = db.Region()
        for ratio, by_diffusion in ((wire.antenna_ratio, safe), (base, more)):
            bad += l2n.antenna_check(gate, 1.0, 0.0, wires[-1], *factors, ratio, [[diffusion, by_diffusion]])
        found[level] = db.Region(list(bad.each()))  # no longer of the extraction, which goes on
    return found
