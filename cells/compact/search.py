"""Narrower cells by a longer search: talbot cells-compact-search --seeds 24:200 --cells dff_x1,dff_x2.

A recipe that beats the kept one goes into recipes.json, which is part of the sources.
"""

import json
import re
from argparse import ArgumentParser, Namespace
from dataclasses import astuple

from talbot.base import jobs
from talbot.base.files import write
from talbot.base.jobs import worker_count
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.catalogue import schematics
from talbot.cells.compact.make import RECIPES, choose, recipe
from talbot.models.parameters import ParameterError


def best(name: str, first: int, last: int, narrower: bool) -> list[object] | None:
    """The best recipe of cell ``name`` from seeds ``first`` to ``last``; narrower: than the kept one."""
    choice = choose(schematics()[name], Canvas(), range(first, last), recipe(name) if narrower else None)
    return list(astuple(choice)) if choice else None


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cells-compact-search`."""
    parser.add_argument("--seeds", default="0:24", help="first:last")
    parser.add_argument("--from-scratch", action="store_true", help="do not compare with the recipes that are kept")
    parser.add_argument("--cells", help="names with commas between (default: all)")
    parser.add_argument("--workers", type=worker_count, default=-1, help="processes; -1: all cores")


def run(options: Namespace) -> int:
    """Search and keep the recipes that are better."""
    span = re.fullmatch(r"(\d+):(\d+)", options.seeds)
    if not span:
        raise ParameterError(f"seeds = {options.seeds!r}: must be first:last, as 0:24")
    names = options.cells.split(",") if options.cells else list(schematics())
    if unknown := sorted(set(names) - schematics().keys()):
        raise ParameterError(f"cells = {unknown[0]!r}: must be one of {', '.join(schematics())}")
    first, last, scratch = int(span[1]), int(span[2]), options.from_scratch
    suffix = f"{span[1]}-{span[2]}{'.from_scratch' if scratch else ''}"
    search_arguments = first, last, not scratch
    todo = [jobs.Job(f"{name}.{suffix}", best, (name, *search_arguments), (recipe(name), Canvas())) for name in names]
    recipes = jobs.run(todo, "build/cells/compact/search", "cells searched", options.workers)
    recipes_on_disk = json.loads(RECIPES.read_text(encoding="utf-8"))
    better = {name: result for name, result in zip(names, recipes, strict=True) if result}
    for name, (sites, met1, seed, _) in better.items():
        was = recipes_on_disk.get(name, ["none"])[0]
        print(f"{name}: {sites} sites{' with met1' if met1 else ''} (seed {seed}); it was {was}")
    lines = (f'"{name}": {json.dumps(result)}' for name, result in sorted({**recipes_on_disk, **better}.items()))
    write(RECIPES, "{\n" + ",\n".join(lines) + "\n}\n")
    return 0
