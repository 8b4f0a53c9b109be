"""A cell from its schematic: the narrowest placement that routes and breaks no rule.

recipes.json holds what a longer search has found (python -m cells.flexcell.search): a seed of the placement, where
extra gaps are, whether met1 is used. With it a cell is drawn at once; without it, it is searched for.
"""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from cells.flexcell.assemble import assemble, task
from cells.flexcell.draw import Drawing
from cells.flexcell.place import breaks, place
from cells.flexcell.route import route
from cells.flexcell.rules import broken

RECIPES = Path(__file__).with_name("recipes.json")
SEEDS = 24          # placements tried when there is no recipe
GAPS = 3            # extra gaps at most
WIDE = 8            # gate columns from which li alone is not tried


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
    drawing = known and _draw(schematic, place(schematic, known.seed), known.spread, canvas, known.met1)
    if not drawing:
        known = next(search(schematic, canvas, range(SEEDS)), None)
        if known is None:
            raise NoLayout(f"{schematic.name}: none of {SEEDS} placements with up to {GAPS} extra gaps could be routed")
        drawing = _draw(schematic, place(schematic, known.seed), known.spread, canvas, known.met1)
    return {"width": drawing.width, "recipe": [known.sites, known.met1, known.seed, known.spread],
            "shapes": [asdict(shape) for shape in drawing.shapes]}


def search(schematic, canvas, seeds, below=None):
    """Recipes that work, the narrowest first and of these those on li alone. below: a Recipe that they have to beat."""
    placed = {}
    for seed in seeds:
        columns = place(schematic, seed)
        placed.setdefault(tuple(columns), seed)
    tried = []
    for columns, seed in placed.items():
        for extra in range(GAPS + 1):
            sites = len(columns) + 1 + len(breaks(columns)) + extra
            tried += [Recipe(sites, met1, seed, spread) for met1 in ((False, True) if len(columns) < WIDE else (True,))
                      for spread in _spreads(columns, extra, seed)]
    by_seed = {seed: columns for columns, seed in placed.items()}
    for trial in sorted(tried):
        if below is not None and not trial < below:
            return
        drawing = _draw(schematic, list(by_seed[trial.seed]), trial.spread, canvas, trial.met1)
        if drawing:
            yield trial


def _draw(schematic, columns, spread, canvas, met1):
    """Drawing, or None where it cannot be routed or breaks a rule."""
    made = assemble(columns, spread)
    wiring = route(task(made, canvas, schematic.ports), met1)
    if wiring is None:
        return None
    drawing = Drawing(canvas, made, wiring)
    return None if broken(drawing) else drawing


def _spreads(columns, extra, seed):
    """Where ``extra`` gaps go: a few choices, spread over the cell."""
    free = [k for k in range(len(columns) - 1) if k not in breaks(columns)]
    if extra == 0:
        return [()]
    if len(free) < extra:
        return []
    step = len(free) / extra
    choices = (tuple(sorted({free[int(i * step + shift * step / 3 + seed) % len(free)] for i in range(extra)}))
               for shift in range(3))
    return sorted({choice for choice in choices if len(choice) == extra})
