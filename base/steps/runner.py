"""Steps run in order, each result in a folder named after all that decides it: complete, or absent."""

import inspect
import json
import multiprocessing
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import asdict
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from threading import Event, Semaphore
from typing import Any

import joblib

from talbot.base.cache import cached, digest
from talbot.base.paths import ROOT
from talbot.base.progress import ended
from talbot.base.sources import code, modules

from .alone import alone
from .step import Step, StepError
from .versions import version

RECORD = "record.json"
Record = dict[str, Any]  # of a step's run, as record.json holds it


class Runner:
    """Runs steps into ``folder``/<step>.<digest>/ and knows the paths of their outputs.

    files: name -> path, what is given from outside. note: called with a line about progress. shared: folder of the
    steps that other runs share. root: of the repository whose files decide what a step does.
    """

    def __init__(
        self,
        folder: Path | str,
        files: Mapping[str, Path | str],
        note: Callable[[str], object] = lambda text: None,
        shared: Path | str | None = None,
        root: Path = ROOT,
    ) -> None:
        self.folder, self.shared, self.note, self.root = Path(folder), Path(shared or folder), note, root
        self.paths = {name: Path(path) for name, path in files.items()}
        self.records: dict[str, Record] = {}

    def run(self, step: Step[Any]) -> Record:
        """Return the record of ``step``, run now or earlier with the same inputs. Raises StepError."""
        missing = sorted(set(step.inputs.values()) - set(self.paths))
        if missing:
            raise StepError(f"{step.name}: nothing gives its input {', '.join(missing)}")
        inputs = {name: self.paths[source] for name, source in step.inputs.items()}
        hashes = {name: digest(path) for name, path in inputs.items()}
        tools = {tool: version(tool) for tool in step.tools}
        parameters = asdict(step.parameters)
        key = digest(source_of(step, self.root), json.dumps([parameters, hashes, tools], sort_keys=True, default=str))

        def make(part: Path) -> None:
            """Run the step into ``part``, with its record."""
            self.note(step.name)
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
            self.note(ended(step.name, record["wall_s"]))

        made = cached((self.shared if step.shared else self.folder) / f"{step.name}.{key}", make)
        for name, file in step.outputs.items():
            self.paths[f"{step.name}.{name}"] = made / file
        self.records[step.name] = json.loads((made / RECORD).read_text())
        return self.records[step.name]

    def run_all(self, steps: Sequence[Step[Any]]) -> list[Record]:
        """Return the records of ``steps`` in their order.

        A step begins when its inputs are complete: at once if others wait for it, else when a core is free. Raises
        StepError, also for steps that need each other in a cycle.
        """
        made_by = {f"{step.name}.{name}": step.name for step in steps for name in step.outputs}
        needs = {step.name: {made_by[source] for source in step.inputs.values() if source in made_by} for step in steps}
        try:
            TopologicalSorter(needs).prepare()
        except CycleError as error:
            raise StepError(f"steps: {' needs '.join(reversed(error.args[1]))}") from None
        awaited, failed, cores = set().union(*needs.values()), Event(), Semaphore(joblib.cpu_count())
        ended = {step.name: Event() for step in steps}

        def begin(step: Step[Any]) -> None:
            """Wait for what ``step`` needs, then run it."""
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

        # A thread for each step, in batches of one: a step that waits blocks no other. joblib has no types
        parallel = joblib.Parallel(n_jobs=len(steps), backend="threading", batch_size=1)  # pyright: ignore[reportArgumentType]
        try:
            parallel(joblib.delayed(begin)(step) for step in steps)
        except BaseException:
            for child in multiprocessing.active_children():  # else their threads wait for them to the end
                child.terminate()
            raise
        return [self.records[step.name] for step in steps]


def source_of(step: Step[Any], root: Path = ROOT) -> str:
    """Digest of every file of the repository that decides what ``step`` does: see `base.sources`.

    Of the platforms only the one that the parameter ``pdk`` names counts, where there is one.
    """
    names = dict.fromkeys(cls.__module__ for cls in type(step).__mro__ if cls.__module__ not in ("builtins", "typing"))
    inside = [name for name in names if name in modules(root)]
    outside = [inspect.getsource(sys.modules[name]) for name in names if name not in inside]
    pdk = getattr(step.parameters, "pdk", None)
    chosen = {"talbot.platforms": pdk.replace("-", "_")} if isinstance(pdk, str) else {}
    return digest(code(*inside, *step.starts(), chosen=chosen, root=root), *outside)


def _check(step: Step[Any], part: Path, metrics: Mapping[str, object]) -> None:
    """Raise StepError unless the step wrote what it declares and no more (logs aside)."""
    made, declared = {path.name for path in part.iterdir()}, set(step.outputs.values())
    lacking, more = declared - made, {name for name in made - declared if not name.endswith(".log")}
    if lacking or more:
        raise StepError(f"{step.name}: did not write {sorted(lacking)}, wrote undeclared {sorted(more)}")
    if set(metrics) != set(step.metrics):
        raise StepError(f"{step.name}: metrics {sorted(metrics)}, declared are {sorted(step.metrics)}")
