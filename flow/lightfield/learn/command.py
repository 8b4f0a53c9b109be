"""Learn the dictionary of `sparse` or the weights of `two_branch` again, from scenes of dead leaves."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.flow.frame import arguments as text

STEPS = {"dictionary": 60, "branches": 5000}
FIRST = 1000  # seed of the first scene; those of the tests and figures are below


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot learn`: texts, checked by `run`."""
    add = parser.add_argument
    what = "dictionary (NumPy alone) or branches (PyTorch: pip install 'talbot[nn]')"
    add("what", choices=STEPS, help=what)
    add("--seed", default="1", help="of everything random, 0..1000000")
    add("--scenes", default="24", help="to learn from, 1..10000")
    default = ", ".join(f"{steps} of the {what}" for what, steps in STEPS.items())
    add("--steps", default="", help=f"of the learning, 1..1000000 (default: {default})")
    add("--atoms", default="512", help="of the dictionary, 2..4096")
    add("--out", default="build/learn", help="folder for <what>.npz, which models/reconstruct ships, and <what>.json")


def run(options: Namespace) -> int:
    """Learn, and print how well; the files are there when all is done."""
    from talbot.base.files import check_folder, staged

    seed = text.integer("seed", options.seed, 0, 10**6)
    scenes = text.integer("scenes", options.scenes, 1, 10**4)
    steps = text.integer("steps", options.steps or str(STEPS[options.what]), 1, 10**6)
    atoms = text.integer("atoms", options.atoms, 2, 4096)
    out = Path(options.out)
    check_folder("out", out)
    seeds = range(FIRST, FIRST + scenes)
    if options.what == "dictionary":
        from .dictionary import learned

        made = learned(seeds, atoms, steps, seed)
    else:
        from .branches import learned

        made = learned(seeds, steps, seed)
    with staged(out) as part:
        made.save(part / f"{options.what}.npz")
        (part / f"{options.what}.json").write_text(json.dumps(made.summary, indent=1) + "\n", encoding="utf-8")
    print(f"{options.what}: {made.text}")
    print(f"look at {out / options.what}.json; talbot/models/reconstruct/{options.what}.npz is the one that is used")
    return 0
