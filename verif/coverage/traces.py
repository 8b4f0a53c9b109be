"""The recorded traces of blocks, kept while nothing changes that decides them."""

import hashlib
from pathlib import Path

from base.jobs import Job, run
from models.parameters import SensorParameters
from rtl.replay import load, record
from rtl.tops import build_top
from verif.results import OUT, ROOT, sources

STORE = OUT / "traces"
DECIDES = "rtl", "models", "pixels", "rtl/replay"


def digest():
    """Of all that decides a trace: text. Proofs beside the blocks do not."""
    h = hashlib.sha256()
    for path in sources(*DECIDES):
        if path.suffix in (".py", ".rdl") and "formal" not in path.parts:
            h.update(str(path.relative_to(ROOT)).encode())
            h.update(path.read_bytes())
    return h.hexdigest()[:16]


def recorded(blocks, store=STORE):
    """Record the tests of ``blocks`` where that is not done: dict block -> .json paths.

    The first is that of the default sensor's parameters if the tests have them, else the one of most cycles.
    """
    now, store = digest(), Path(store)
    jobs = [Job(block, _record, (block, str(store / f"{block}-{now}")), (now,)) for block in blocks]
    for job in jobs:
        if not Path(job.arguments[1]).exists():  # its files were removed: the kept result is none
            (store / f"{job.name}.{job.digest}.json").unlink(missing_ok=True)
    return {
        block: [Path(path) for path in paths]
        for block, paths in zip(blocks, run(jobs, store, "recorded tests"), strict=True)
    }


def _record(block, folder):
    top = build_top(block, SensorParameters())
    default = repr((*top._dsl.args, *top._dsl.kwargs.values()))

    def rank(path):
        head = load(path, cycles=False)
        return repr(head.arguments) != default, -head.cycles

    return [str(path) for path in sorted(record(block, folder), key=rank)]
