"""A cell from its schematic: the narrowest placement that routes and breaks no rule.

recipes.json holds the results of longer searches: a seed of the placement, where extra gaps are, whether met1 is used.
With a recipe a cell is drawn at once, without one a placement is searched.
"""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path

from talbot.cells.compact.assemble import assemble, task
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.draw import Drawing, Drawn
from talbot.cells.compact.place import Column, breaks, place
from talbot.cells.compact.route import route
from talbot.cells.compact.rules import broken
from talbot.cells.compact.transistors import Schematic

RECIPES = Path(__file__).with_name("recipes.json")
SEEDS = 24  # placements tried when there is no recipe
GAPS = 3  # extra gaps at most
CHOICES = 30  # recipes of one width that are compared
WIDE = 8  # gate columns from which li alone is not tried


class NoLayout(RuntimeError):
    """No placement of a cell could be routed."""


@dataclass(frozen=True, order=True)
class Recipe:
    """A drawing of a cell: width in sites, whether met1 is used, seed of `place`, columns with an extra gap after."""

    sites: int
    met1: bool
    seed: int
    spread: tuple[int, ...]


def recipe(name: str) -> Recipe | None:
    """The Recipe kept for cell ``name``, or None."""
    kept = json.loads(RECIPES.read_text(encoding="utf-8")).get(name)
    return Recipe(kept[0], kept[1], kept[2], tuple(kept[3])) if kept else None


def make(schematic: Schematic, canvas: Canvas, known: Recipe | None = None) -> Drawn:
    """Draw a cell, by the Recipe ``known`` where that works. Raises NoLayout."""
    drawing = known and _draw(schematic, place(schematic, known.seed), known, canvas)
    if not drawing:
        known = choose(schematic, canvas, range(SEEDS))
        drawing = known and _draw(schematic, place(schematic, known.seed), known, canvas)
    if not known or not drawing:
        raise NoLayout(f"{schematic.name}: none of {SEEDS} placements with up to {GAPS} extra gaps could be routed")
    return {"width": drawing.width, "recipe": list(astuple(known)), "shapes": [*drawing.shapes]}


def choose(schematic: Schematic, canvas: Canvas, seeds: Iterable[int], below: Recipe | None = None) -> Recipe | None:
    """Choose of the narrowest recipes from ``seeds`` the one with the most `merit`; None where no placement routes."""
    candidates = []
    for recipe, drawing in search(schematic, canvas, seeds, below):
        if candidates and (recipe.sites > candidates[0][1].sites or len(candidates) == CHOICES):
            break
        candidates.append((merit(drawing), recipe))
    return max(candidates, key=lambda pair: pair[0])[1] if candidates else None


def merit(drawing: Drawing) -> tuple[int, int]:
    """Pin access (tracks of met1 that the least accessible pin meets, at most 3), then less met1 inside."""
    tracks, spans = drawing.canvas.tracks, [(s.bottom, s.top) for s in drawing.shapes if s.layer == "li.pin"]
    pins = [sum(low <= t - 0.16 + 1e-9 and t + 0.16 <= high + 1e-9 for t in tracks) for low, high in spans]
    return min(3, *pins, 3), -sum(s.layer == "m1" for s in drawing.shapes)


def search(
    schematic: Schematic, canvas: Canvas, seeds: Iterable[int], below: Recipe | None = None
) -> Iterator[tuple[Recipe, Drawing]]:
    """Find what works, the narrowest first and of these those on li alone; narrower than ``below``."""
    placed = {seed: place(schematic, seed) for seed in seeds}
    tried = []
    for seed, columns in placed.items():
        for extra in range(GAPS + 1):
            sites = len(columns) + 1 + len(breaks(columns)) + extra
            layers, spreads = (False, True) if len(columns) < WIDE else (True,), _spreads(columns, extra, seed)
            tried += [Recipe(sites, met1, seed, spread) for met1 in layers for spread in spreads]
    for trial in sorted(tried):
        if below is not None and trial.sites >= below.sites:
            return
        if drawing := _draw(schematic, placed[trial.seed], trial, canvas):
            yield trial, drawing


def _draw(schematic: Schematic, columns: Sequence[Column], recipe: Recipe, canvas: Canvas) -> Drawing | None:
    """The drawing, None where it cannot be routed or breaks a rule."""
    assembly = assemble(columns, recipe.spread)
    wiring = route(task(assembly, canvas, schematic.ports), recipe.met1, recipe.seed)
    if wiring is None:
        return None
    drawings = (Drawing(canvas, assembly, wiring, reach) for reach in (True, False))
    return next((drawing for drawing in drawings if not broken(drawing)), None)


def _spreads(columns: Sequence[Column], extra: int, seed: int) -> list[tuple[int, ...]]:
    """Choose where ``extra`` gaps go: a few choices, spread over the cell."""
    free = [k for k in range(len(columns) - 1) if k not in breaks(columns)]
    if extra == 0:
        return [()]
    if len(free) < extra:
        return []
    step = len(free) / extra
    places = [[int(i * step + shift * step / 3 + seed) % len(free) for i in range(extra)] for shift in range(3)]
    choices = {tuple(sorted({free[place] for place in some})) for some in places}
    return sorted(choice for choice in choices if len(choice) == extra)
