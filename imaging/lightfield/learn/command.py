"""Learn the dictionary of `sparse` or the weights of `two_branch` again, from scenes of dead leaves."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.arguments import Number

STEPS = {"dictionary": 60, "branches": 5000}
FIRST = 1000  # seed of the first scene; those of the tests and figures are below

SEED = Number("seed", "of everything random", 0, 10**6, "1")
SCENES = Number("scenes", "to learn from", 1, 10**4, "24")
NOTE = ", ".join(f"{steps} for {what}" for what, steps in STEPS.items())
STEPS_TRAINED = Number("steps", "of the training", 1, 10**6, note=NOTE)
ATOMS = Number("atoms", "of the dictionary", 2, 4096, "512")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot learn`: texts, checked by `run`."""
    add = parser.add_argument
    what = "dictionary (NumPy alone) or branches (PyTorch: pip install 'talbot[nn]')"
    add("what", choices=STEPS, help=what)
    for number in (SEED, SCENES, STEPS_TRAINED, ATOMS):
        number.add(parser)
    add("--out", default="build/learn", help="folder for <what>.npz, which models/reconstruct ships, and <what>.json")


def run(options: Namespace) -> int:
    """Learn, and print how well; the files are there when all is done."""
    from talbot.base.files import check_folder, staged

    seed, scenes, atoms = (number.value(options) for number in (SEED, SCENES, ATOMS))
    steps = STEPS_TRAINED.value(options) or STEPS[options.what]
    out = Path(options.out)
    check_folder("out", out)
    seeds = range(FIRST, FIRST + scenes)
    if options.what == "dictionary":
        from talbot.imaging.lightfield.learn.dictionary import learned

        result = learned(seeds, atoms, steps, seed)
    else:
        from talbot.imaging.lightfield.learn.branches import learned

        result = learned(seeds, steps, seed)
    with staged(out) as part:
        result.save(part / f"{options.what}.npz")
        (part / f"{options.what}.json").write_text(json.dumps(result.summary, indent=1) + "\n", encoding="utf-8")
    print(f"{options.what}: {result.text}")
    print(f"look at {out / options.what}.json; talbot/models/reconstruct/{options.what}.npz is the one that is used")
    return 0
