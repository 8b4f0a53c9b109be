"""The recorded traces of blocks, kept until a file in their key changes."""

from collections.abc import Collection
from pathlib import Path
from typing import Any

from talbot.base.cache import digest
from talbot.base.jobs import Job, run
from talbot.base.paths import ROOT
from talbot.base.sources import code
from talbot.models.parameters import SensorParameters
from talbot.rtl.replay import load, record, tests_of
from talbot.rtl.tops import build_top
from talbot.verif.results import OUT

STORE = OUT / "traces"


def recorded(blocks: Collection[str], store: Path = STORE) -> dict[str, list[Path]]:
    """Return the .json files of the traces of ``blocks``, recorded where they are not kept in folder ``store``.

    The first of a block has the default sensor's parameters if a test has them, else the most cycles.
    """
    jobs = []
    for block in blocks:
        tests = code(tests_of(block)[1].relative_to(ROOT))
        folder = store / f"{block}-{digest(tests, code(__name__))}"
        jobs.append(Job(block, _record, (block, str(folder)), (tests,)))
    for job in jobs:
        if not Path(job.arguments[1]).exists():  # its files were removed: the kept result is none
            job.file(store).unlink(missing_ok=True)
    return {
        block: [Path(path) for path in paths]
        for block, paths in zip(blocks, run(jobs, store, "recorded tests"), strict=True)
    }


def _record(block: str, folder: str) -> list[str]:
    top: Any = build_top(block, SensorParameters())
    default = repr((*top._dsl.args, *top._dsl.kwargs.values()))

    def rank(path: Path | str) -> tuple[bool, int]:
        head = load(path, cycles=False)
        return repr(head.arguments) != default, -head.cycles

    return [str(path) for path in sorted(record(block, folder), key=rank)]
