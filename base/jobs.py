"""Independent jobs over cores or a cluster, each result kept: a killed run goes on from where it was.

joblib schedules: all cores by default, a Dask cluster where SCHEDULER=tcp://host:port is set.
"""

import contextlib
import hashlib
import json
import os
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import joblib
from tqdm import tqdm

from models.parameters import ParameterError


@dataclass(frozen=True)
class Job:
    """One call: ``call(*arguments)`` returns what JSON can hold. name: unique in its step, a file name.

    inputs: files, texts and numbers that decide the result; another digest of them is another job.
    """

    name: str
    call: Callable
    arguments: tuple = ()
    inputs: tuple = ()

    @property
    def digest(self):
        h = hashlib.sha256(self.name.encode())
        for part in self.inputs:
            h.update(part.read_bytes() if isinstance(part, Path) else str(part).encode())
            h.update(b"\0")
        return h.hexdigest()[:16]


def run(jobs, store, title, workers=-1):
    """Results of ``jobs`` (a sequence of Job) in their order: list.

    store: folder of the kept results, <name>.<digest>.json. title: of the progress bar. workers: processes, -1 for
    all cores. An exception in a job ends the run; what was done before stays done.
    """
    store = Path(store)
    store.mkdir(parents=True, exist_ok=True)
    jobs = list(jobs)
    names = [job.name for job in jobs]
    if len(set(names)) != len(names):
        raise ParameterError(f"jobs = {title}: two have one name")
    files = [store / f"{job.name}.{job.digest}.json" for job in jobs]
    todo = [(job, file) for job, file in zip(jobs, files, strict=True) if not file.exists()]
    with tqdm(total=len(jobs), initial=len(jobs) - len(todo), desc=title, disable=None) as bar, _backend(workers):
        calls = (joblib.delayed(_keep)(job, file) for job, file in todo)
        with warnings.catch_warnings():  # joblib renews a process that has grown, and says so
            warnings.filterwarnings("ignore", "A worker stopped while some jobs", UserWarning)
            for _ in joblib.Parallel(return_as="generator_unordered", batch_size=1)(calls):
                bar.update()
    return [json.loads(file.read_text()) for file in files]


@contextlib.contextmanager
def _backend(workers):
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


def _keep(job, file):
    result = json.dumps(job.call(*job.arguments), indent=1, allow_nan=False)
    part = file.with_name(f".{file.name}.part-{os.getpid()}")
    part.write_text(result + "\n")
    os.replace(part, file)
