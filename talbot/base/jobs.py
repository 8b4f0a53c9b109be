"""Independent jobs over cores or a cluster, each result kept: a killed run goes on from where it was.

joblib schedules: all cores by default, a Dask cluster where SCHEDULER=tcp://host:port is set.
"""

import argparse
import contextlib
import json
import math
import os
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, is_dataclass
from pathlib import Path
from typing import Any

import joblib

from talbot.base.cache import digest
from talbot.base.check import work_begins
from talbot.base.files import write
from talbot.base.progress import each
from talbot.base.sources import code
from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError


@dataclass(frozen=True)
class Job:
    """A call: ``call(*arguments)`` returns JSON or dataclasses (which `base.records.from_json` reads back).

    name: unique among the jobs of a run, a file name. inputs: paths (their content counts), texts and numbers that
    decide the result next to the code of ``call``, which is found by itself.
    """

    name: str
    call: Callable[..., Any]
    arguments: tuple[Any, ...] = ()
    inputs: tuple[object, ...] = ()

    @property
    def digest(self) -> str:
        """The key of the result: of the name, of all code that ``call`` may run (`base.sources`) and of the inputs."""
        return digest(self.name, code(self.call.__module__), *self.inputs)

    def file(self, store: Path) -> Path:
        """Return the file of the kept result in the folder ``store``."""
        return store / f"{self.name}.{self.digest}.json"


def worker_count(text: str) -> int:
    """Return a number of processes from an argument: 1 or more, or -1 for all cores."""
    count = int(text) if text.lstrip("-").isdecimal() else 0
    if count < 1 and count != -1:
        raise argparse.ArgumentTypeError(f"{text!r}: must be 1 or more, or -1 for all cores")
    return count


def run(jobs: Iterable[Job], store: Path | str, title: str, workers: int = -1) -> list[Any]:
    """Return the results of ``jobs`` in their order.

    store: folder of the kept results; one that is damaged is computed again. title: of the progress bar. workers:
    processes, -1 for all cores. An exception in a job ends the run; results of earlier jobs are kept. Raises
    ParameterError.
    """
    work_begins()
    store = Path(store)
    store.mkdir(parents=True, exist_ok=True)
    jobs = list(jobs)
    names = [job.name for job in jobs]
    if len(set(names)) != len(names):
        raise ParameterError(f"jobs = {title}: two have one name")
    files = [job.file(store) for job in jobs]
    before = [kept(file) for file in files]
    todo = [(job, file) for job, file, found in zip(jobs, files, before, strict=True) if not found]
    with _backend(workers):
        calls = (joblib.delayed(_keep)(job, file) for job, file in todo)
        with restarts():
            # joblib has no types: pyright takes those of its defaults
            parallel = joblib.Parallel(return_as="generator_unordered", batch_size=1)  # pyright: ignore[reportArgumentType]
            for _ in each(parallel(calls), title, str, len(todo)):
                pass
    done = [found or kept(file) for file, found in zip(files, before, strict=True)]
    if not all(done):
        raise ToolError(f"store = {store}: results of this run are gone: another process has removed them")
    return [found[0] for found in done]


@contextlib.contextmanager
def restarts() -> Iterator[None]:
    """Leave out the warning with which joblib restarts a process that has grown."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "A worker stopped while some jobs", UserWarning)
        yield


def kept(file: Path) -> list[Any]:
    """Return the one value of a JSON file; [] where there is none that can be read, or not the whole of one."""
    try:
        return [json.loads(file.read_text(encoding="utf-8"))]
    except (OSError, ValueError):
        return []


@contextlib.contextmanager
def _backend(workers: int) -> Iterator[None]:
    scheduler = os.environ.get("SCHEDULER")
    if not scheduler:
        with joblib.parallel_config(backend="loky", n_jobs=workers):
            yield
        return
    try:
        from distributed import Client

        client = Client(scheduler, timeout="10s")
    except (OSError, ValueError) as error:
        raise ParameterError(f"SCHEDULER = {scheduler!r}: no Dask scheduler answers there ({error})") from None
    with client, joblib.parallel_config(backend="dask", wait_for_workers_timeout=60):
        yield


def _keep(job: Job, file: Path) -> str:
    """Run a job and keep its result; returns its name."""
    found = job.call(*job.arguments)
    try:
        result = json.dumps(found, indent=1, allow_nan=False, default=asdict)
    except ValueError as error:
        bad = ", ".join(_not_finite(found))
        raise ToolError(f"{job.name} = {bad or error}: must be finite") from None
    write(file, result + "\n")
    return job.name


def _not_finite(value: Any, name: str = "") -> Iterator[str]:
    """Yield the names of the numbers in JSON that are NaN or infinite, each with its value."""
    if is_dataclass(value) and not isinstance(value, type):
        value = asdict(value)
    if isinstance(value, dict | list | tuple):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _not_finite(item, f"{name}.{key}".lstrip("."))
    elif isinstance(value, float) and not math.isfinite(value):
        yield f"{name} {value}"
