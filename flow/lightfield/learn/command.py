"""Learn the dictionary of sparse coding, or a network, again: from scenes of dead leaves, which no figure is from."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.flow.frame import arguments as text
from talbot.models.parameters import ParameterError

STEPS = {"dictionary": 60, "network": 2500, "branches": 5000}
FIRST = 1000  # seed of the first scene; those of the tests and figures are below


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot learn`: texts, checked by `run`."""
    add = parser.add_argument
    what = "dictionary (NumPy alone), network, or branches (PyTorch: pip install 'talbot[nn]')"
    add("what", choices=STEPS, help=what)
    add("--seed", default="1", help="of everything random, 0..1000000")
    add("--scenes", default="24", help="to learn from, 1..10000")
    default = ", ".join(f"{steps} of the {what}" for what, steps in STEPS.items())
    add("--steps", default="", help=f"of the learning, 1..1000000 (default: {default})")
    add("--atoms", default="512", help="of the dictionary, 2..4096")
    add("--start", help="weights of the network to go on from (default: none)")
    add("--out", default="build/learn", help="folder for <what>.npz, which models/reconstruct ships, and <what>.json")


def run(options: Namespace) -> int:
    """Learn, and print how well; the files are there when all is done."""
    from talbot.base.files import check_folder, staged

    seed = text.integer("seed", options.seed, 0, 10**6)
    scenes = text.integer("scenes", options.scenes, 1, 10**4)
    steps = text.integer("steps", options.steps or str(STEPS[options.what]), 1, 10**6)
    atoms = text.integer("atoms", options.atoms, 2, 4096)
    out, start = Path(options.out), Path(options.start) if options.start else None
    if start is not None and not start.is_file():
        raise ParameterError(f"start = {str(start)!r}: must be a file of weights")
    check_folder("out", out)
    seeds = range(FIRST, FIRST + scenes)
    if options.what == "dictionary":
        from .dictionary import learned

        made = learned(seeds, atoms, steps, seed)
    elif options.what == "branches":
        from .branches import learned

        made = learned(seeds, steps, seed)
    else:
        from .training import learned

        made = learned(seeds, steps, seed, start)
    with staged(out) as part:
        made.save(part / f"{options.what}.npz")
        (part / f"{options.what}.json").write_text(json.dumps(made.summary, indent=1) + "\n", encoding="utf-8")
    print(f"{options.what}: {made.text}")
    print(f"look at {out / options.what}.json; talbot/models/reconstruct/{options.what}.npz is the one that is used")
    return 0
