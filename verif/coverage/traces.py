"""The recorded traces of blocks, kept while nothing changes that decides them."""

from pathlib import Path

from verif.jobs import Job, run
from verif.replay import record
from verif.results import OUT, digest_of

STORE = OUT / "traces"
DECIDES = "rtl", "models", "pixels", "verif/replay"


def recorded(blocks, store=STORE):
    """Record the tests of ``blocks`` where that is not done: dict block -> .json paths, the longest trace first."""
    digest = digest_of(*DECIDES)[:16]
    jobs = []
    for block in blocks:
        folder = Path(store) / f"{block}-{digest}"
        # A kept result whose files were removed is no result
        jobs.append(Job(block, _record, (block, str(folder)), (digest, folder.exists())))
    return {block: [Path(path) for path in paths]
            for block, paths in zip(blocks, run(jobs, store, "recorded tests"), strict=True)}


def _record(block, folder):
    return [str(path) for path in record(block, folder)]
