"""A cell from its schematic: the narrowest placement that routes and breaks no rule."""

from dataclasses import asdict

from cells.flexcell.assemble import assemble, task
from cells.flexcell.draw import Drawing
from cells.flexcell.place import breaks, place
from cells.flexcell.route import route
from cells.flexcell.rules import broken

SEEDS = 24          # placements tried for each number of extra gaps
GAPS = 3            # extra gaps at most


class NoLayout(RuntimeError):
    """No placement of a cell could be routed."""


def make(schematic, canvas):
    """What was drawn, as JSON can hold it: dict with width (um), shapes (list of dicts), met1 (is it used?), seed.

    Raises NoLayout.
    """
    placed = {}
    for seed in range(SEEDS):
        columns = place(schematic, seed)
        placed.setdefault(len(breaks(columns)), {})[tuple(columns)] = (seed, columns)
    tried = [(count + extra, extra, seed, columns) for extra in range(GAPS + 1)
             for count, found in placed.items() for seed, columns in found.values()]
    tried.sort(key=lambda t: t[:3])
    for met1 in (False, True):
        for _, extra, seed, columns in tried if met1 else [t for t in tried if t[0] == tried[0][0]]:
            for spread in _spreads(columns, extra, seed):
                made = assemble(columns, spread)
                wiring = route(task(made, canvas, schematic.ports), met1)
                if wiring is None:
                    continue
                drawing = Drawing(canvas, made, wiring)
                if not broken(drawing):
                    return {"width": drawing.width, "seed": seed, "gaps": extra,
                            "met1": any(v[0] == "met1" for vs in wiring.vertices.values() for v in vs),
                            "shapes": [asdict(shape) for shape in drawing.shapes]}
    raise NoLayout(f"{schematic.name}: no placement of {SEEDS} with up to {GAPS} extra gaps could be routed")


def _spreads(columns, extra, seed):
    """Where ``extra`` gaps go: a few choices, spread over the cell."""
    free = [k for k in range(len(columns) - 1) if k not in breaks(columns)]
    if extra == 0:
        return [()]
    if len(free) < extra:
        return []
    step = len(free) / extra
    return [tuple(sorted({free[int(i * step + shift * step / 3 + seed) % len(free)] for i in range(extra)}))
            for shift in range(3)]
