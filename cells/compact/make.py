"""A cell from its schematic: the narrowest placement that routes and breaks no rule.

recipes.json holds what a longer search has found (talbot cells-compact-search): a seed of the placement, where
extra gaps are, whether met1 is used. With it a cell is drawn at once; without it, it is searched for.
"""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from cells.compact.assemble import assemble, task
from cells.compact.draw import Drawing
from cells.compact.place import breaks, place
from cells.compact.route import route
from cells.compact.rules import broken

RECIPES = Path(__file__).with_name("recipes.json")
SEEDS = 24  # placements tried when there is no recipe
GAPS = 3  # extra gaps at most
CHOICES = 30  # recipes of one width that are compared
WIDE = 8  # gate columns from which li alone is not tried


class NoLayout(RuntimeError):
    """No placement of a cell could be routed."""


@dataclass(frozen=True, order=True)
class Recipe:
    """sites: width; met1: is it used?; seed: of `place`; spread: indices of columns with an extra gap behind them."""

    sites: int
    met1: bool
    seed: int
    spread: tuple


def recipe(name):
    """The Recipe kept for cell ``name``, or None."""
    kept = json.loads(RECIPES.read_text()).get(name) if RECIPES.exists() else None
    return Recipe(kept[0], kept[1], kept[2], tuple(kept[3])) if kept else None


def make(schematic, canvas, known=None):
    """What was drawn, as JSON can hold it: dict with width (um), shapes (list of dicts) and its recipe (list).

    known: a Recipe to follow, should it still work. Raises NoLayout.
    """
    drawing = known and _draw(schematic, place(schematic, known.seed), known, canvas)
    if not drawing:
        known = choose(schematic, canvas, range(SEEDS))
        if known is None:
            raise NoLayout(f"{schematic.name}: none of {SEEDS} placements with up to {GAPS} extra gaps could be routed")
        drawing = _draw(schematic, place(schematic, known.seed), known, canvas)
    return {
        "width": drawing.width,
        "recipe": [known.sites, known.met1, known.seed, known.spread],
        "shapes": [asdict(shape) for shape in drawing.shapes],
    }


def choose(schematic, canvas, seeds, below=None):
    """Of the narrowest Recipes from ``seeds`` the one that is best to route to, or None; see `search`, `merit`."""
    found = []
    for one, drawing in search(schematic, canvas, seeds, below):
        if found and (one.sites > found[0][1].sites or len(found) == CHOICES):
            break
        found.append((merit(drawing), one))
    return max(found, key=lambda pair: pair[0])[1] if found else None


def merit(drawing):
    """(tracks of met1 that the least accessible pin meets, at most 3; less met1 inside), the more the better."""
    c = drawing.canvas
    tracks = [k * c.site for k in range(1, round(c.height / c.site))]
    pins = [
        sum(s.bottom <= t - 0.16 + 1e-9 and t + 0.16 <= s.top + 1e-9 for t in tracks)
        for s in drawing.shapes
        if s.layer == "li.pin"
    ]
    return min(3, *pins, 3), -sum(s.layer == "m1" for s in drawing.shapes)


def search(schematic, canvas, seeds, below=None):
    """(Recipe, Drawing) of what works, the narrowest first and of these those on li alone. below: a Recipe to beat in

    width.
    """
    placed = {seed: place(schematic, seed) for seed in seeds}
    tried = []
    for seed, columns in placed.items():
        for extra in range(GAPS + 1):
            sites = len(columns) + 1 + len(breaks(columns)) + extra
            tried += [
                Recipe(sites, met1, seed, spread)
                for met1 in ((False, True) if len(columns) < WIDE else (True,))
                for spread in _spreads(columns, extra, seed)
            ]
    for trial in sorted(tried):
        if below is not None and trial.sites >= below.sites:
            return
        drawing = _draw(schematic, placed[trial.seed], trial, canvas)
        if drawing:
            yield trial, drawing


def _draw(schematic, columns, recipe_, canvas):
    """Drawing, or None where it cannot be routed or breaks a rule."""
    made = assemble(columns, recipe_.spread)
    wiring = route(task(made, canvas, schematic.ports), recipe_.met1, recipe_.seed)
    if wiring is None:
        return None
    drawings = (Drawing(canvas, made, wiring, reach) for reach in (True, False))
    return next((drawing for drawing in drawings if not broken(drawing)), None)


def _spreads(columns, extra, seed):
    """Where ``extra`` gaps go: a few choices, spread over the cell."""
    free = [k for k in range(len(columns) - 1) if k not in breaks(columns)]
    if extra == 0:
        return [()]
    if len(free) < extra:
        return []
    step = len(free) / extra
    choices = (
        tuple(sorted({free[int(i * step + shift * step / 3 + seed) % len(free)] for i in range(extra)}))
        for shift in range(3)
    )
    return sorted({choice for choice in choices if len(choice) == extra})
