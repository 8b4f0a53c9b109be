"""Steps run in order, each result in a folder named after all that went into it: whole, or not there."""

import hashlib
import json
import multiprocessing
import time
from contextlib import nullcontext
from dataclasses import asdict
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from threading import Event, Semaphore

import joblib

from base.cache import cached, digest

from .alone import alone
from .step import StepError
from .versions import version

RECORD = "record.json"


class Runner:
    """Runs steps into ``folder``/<step>.<digest>/ and knows where their outputs lie.

    files: dict name -> Path, what is given from outside. note: called with a line about what is going on. shared:
    folder of the steps that other runs share.
    """

    def __init__(self, folder, files, note=lambda text: None, shared=None):
        self.folder, self.shared, self.note = Path(folder), Path(shared or folder), note
        self.paths = {name: Path(path) for name, path in files.items()}
        self.records = {}

    def run(self, step):
        """The record (dict) of ``step``, run now or earlier with the same inputs. Raises StepError."""
        missing = sorted(set(step.inputs.values()) - set(self.paths))
        if missing:
            raise StepError(f"{step.name}: nothing gives its input {', '.join(missing)}")
        inputs = {name: self.paths[source] for name, source in step.inputs.items()}
        hashes = {name: _hash(path) for name, path in inputs.items()}
        tools = {tool: version(tool) for tool in step.tools}
        parameters = asdict(step.parameters)
        key = digest(step.source(), json.dumps([parameters, hashes, tools], sort_keys=True, default=str))
        self.note(step.name)

        def make(part):
            begin = time.perf_counter()
            outputs = {name: part / file for name, file in step.outputs.items()}
            metrics, peak = alone(step.run, inputs, outputs)
            _check(step, part, metrics)
            record = {
                "step": step.name,
                "metrics": metrics,
                "units": step.metrics,
                "wall_s": round(time.perf_counter() - begin, 2),
                "peak_mib": peak,
                "parameters": parameters,
                "parameter_units": step.units(),
                "tools": tools,
                "inputs": hashes,
            }
            (part / RECORD).write_text(json.dumps(record, indent=1, default=str) + "\n")

        made = cached((self.shared if step.shared else self.folder) / f"{step.name}.{key}", make)
        for name, file in step.outputs.items():
            self.paths[f"{step.name}.{name}"] = made / file
        self.records[step.name] = json.loads((made / RECORD).read_text())
        return self.records[step.name]

    def run_all(self, steps):
        """The records of ``steps``, in their order. Each begins when what it needs is there: at once if others wait for
        it, else when a core is free. Raises StepError, also for steps that need each other in a circle."""
        made_by = {f"{step.name}.{name}": step.name for step in steps for name in step.outputs}
        needs = {step.name: {made_by[source] for source in step.inputs.values() if source in made_by} for step in steps}
        try:
            TopologicalSorter(needs).prepare()
        except CycleError as error:
            raise StepError(f"steps: {' needs '.join(reversed(error.args[1]))}") from None
        awaited, failed, cores = set().union(*needs.values()), Event(), Semaphore(joblib.cpu_count())
        ended = {step.name: Event() for step in steps}

        def begin(step):
            try:
                for name in needs[step.name]:
                    ended[name].wait()
                with nullcontext() if step.name in awaited else cores:
                    if not failed.is_set():
                        self.run(step)
            except BaseException:
                failed.set()
                raise
            finally:
                ended[step.name].set()

        try:  # a thread a step, in batches of one: those that wait take nobody's place
            joblib.Parallel(n_jobs=len(steps), backend="threading", batch_size=1)(
                joblib.delayed(begin)(step) for step in steps
            )
        except BaseException:
            for child in multiprocessing.active_children():  # else their threads wait for them to the end
                child.terminate()
            raise
        return [self.records[step.name] for step in steps]


def _hash(path):
    """Of a file, or of all files of a folder with their names."""
    h = hashlib.sha256()
    for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
        if file.is_file() and "__pycache__" not in file.parts:
            h.update(f"{file.relative_to(path)}\0".encode() + file.read_bytes())
    return h.hexdigest()[:16]


def _check(step, part, metrics):
    """Raise StepError unless the step wrote what it declares and no more (logs aside)."""
    made, declared = {path.name for path in part.iterdir()}, set(step.outputs.values())
    lacking, more = declared - made, {name for name in made - declared if not name.endswith(".log")}
    if lacking or more:
        raise StepError(f"{step.name}: did not write {sorted(lacking)}, wrote undeclared {sorted(more)}")
    if set(metrics) != set(step.metrics):
        raise StepError(f"{step.name}: metrics {sorted(metrics)}, declared are {sorted(step.metrics)}")
