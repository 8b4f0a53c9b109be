"""Metal fill: squares of no net where a layer has room, so that every layer is polished alike."""

import json
from dataclasses import dataclass

from flow.gds import write_gds
from flow.platforms.embedded import process
from flow.steps import Step


@dataclass(frozen=True)
class FillParameters:
    """pdk: process."""

    pdk: str = "sky130"


class Fill(Step):
    """The largest squares first, until a layer has its density or no room. before, after: covered share by layer.

    density_violations: windows with more metal than the process allows. The fill's capacitance is not extracted: it
    stays away from wires by the process's clearance.
    """

    name = "fill"
    inputs = {"gds": "stream_out.gds", "platform": "platform"}
    outputs = {"gds": "layout.gds", "summary": "fill.json"}
    Parameters = FillParameters
    metrics = {"squares": "", "before": "", "after": "", "density_violations": ""}
    tools = ("python klayout",)

    def run(self, inputs, outputs):
        import klayout.db as db
        known, _ = process(self.parameters.pdk)
        layout = db.Layout()
        layout.read(str(inputs["gds"]))
        top, squares = layout.top_cell(), 0
        before = {wire.name: densest(layout, top, wire, known.fill) for wire in known.wires}
        for wire in known.wires[1:]:
            squares += fill(layout, top, wire, known.fill)
        after = {wire.name: densest(layout, top, wire, known.fill) for wire in known.wires}
        write_gds(layout, outputs["gds"])
        dense = {name: density for name, density in after.items() if density > known.fill.density_most}
        told = {"before": before, "after": after, "too dense": dense}
        outputs["summary"].write_text(json.dumps(told, indent=1) + "\n")
        return {"squares": squares, "before": before, "after": after, "density_violations": len(dense)}


def fill(layout, top, wire, rules):
    """Draw the squares of one wire's layer into the cell ``top``; returns how many."""
    import klayout.db as db
    layer, die = layout.layer(wire.layer, wire.datatype), top.bbox()
    metal = db.Region(top.begin_shapes_rec(layer)).merged()
    wanted = rules.density * die.area() - metal.area()
    space, drawn = round(rules.space_um / layout.dbu), 0
    for side in (round(side / layout.dbu) for side in rules.sides_um):
        free = db.Region(die.enlarged(-space)) - metal.sized(round(rules.clearance_um / layout.dbu))
        places = list(squares(die, side, side + space).inside(free).each())
        count = min(len(places), max(0, -(-round(wanted) // side ** 2)))
        chosen = db.Region([places[k * len(places) // count] for k in range(count)])      # evenly over the layer
        top.shapes(layer).insert(chosen)
        metal += chosen.sized(space - round(rules.clearance_um / layout.dbu))     # squares keep their own space
        wanted -= count * side ** 2
        drawn += count
    return drawn


def squares(box, side, pitch):
    """Region of squares on a grid over ``box``, in rows from the lower left."""
    import klayout.db as db
    made = db.Region()
    made.merged_semantics = False
    for y in range(box.bottom, box.top - side, pitch):
        for x in range(box.left, box.right - side, pitch):
            made.insert(db.Box(x, y, x + side, y + side))
    return made


def densest(layout, top, wire, rules):
    """Covered share of a wire's layer in the window of the cell where it is largest; windows overlap by half."""
    import klayout.db as db
    box, size = top.bbox(), round(rules.window_um / layout.dbu)
    metal, found = db.Region(top.begin_shapes_rec(layout.layer(wire.layer, wire.datatype))).merged(), []
    for left in range(box.left, max(box.left + 1, box.right - size // 2), size // 2):
        for bottom in range(box.bottom, max(box.bottom + 1, box.top - size // 2), size // 2):
            window = db.Box(left, bottom, left + size, bottom + size) & box
            found.append((metal & db.Region(window)).area() / window.area())
    return round(max(found), 4)
