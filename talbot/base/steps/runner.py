"""Steps run in order, each result in a folder named after all that decides it: complete, or absent."""

import inspect
import json
import multiprocessing
import sys
import time
from collections import ChainMap, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import asdict
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from threading import Event, Lock, Semaphore, Thread
from typing import Any

from talbot.base.cache import cached, digest
from talbot.base.paths import ROOT
from talbot.base.progress import ended
from talbot.base.sources import code, modules
from talbot.base.steps.alone import alone
from talbot.base.steps.step import Step, StepError
from talbot.base.steps.versions import version
from talbot.base.tools import plain

RECORD = "record.json"
LOOK_S = 0.1  # how often `Runner.beside` looks for a step that can begin
YIELDING = 10  # by which steps yield to those of another run
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
        self.folder, self.shared, self.note, self.root = plain(Path(folder)), plain(Path(shared or folder)), note, root
        self.paths = {name: plain(Path(path)) for name, path in files.items()}
        self.records: dict[str, Record] = {}
        self._running: defaultdict[str, Lock] = defaultdict(Lock)  # by the step's name

    def run(self, step: Step[Any]) -> Record:
        """Return the record of ``step``, run now or earlier with the same inputs. Raises StepError."""
        missing = sorted(set(step.inputs.values()) - set(self.paths))
        if missing:
            raise StepError(f"{step.name}: nothing gives its input {', '.join(missing)}")
        made = self._made(step, self.paths)
        self.paths |= _outputs(step, made)
        self.records[step.name] = json.loads((made / RECORD).read_text(encoding="utf-8"))
        return self.records[step.name]

    def _made(self, step: Step[Any], paths: Mapping[str, Path], nice: int = 0) -> Path:
        """The folder of the step's results, run now or earlier. paths: of all inputs, by source. nice: see `alone`."""
        inputs = {name: paths[source] for name, source in step.inputs.items()}
        hashes = {name: digest(path) for name, path in inputs.items()}
        tools = {tool: version(tool) for tool in step.tools}
        parameters = asdict(step.parameters)
        key = digest(source_of(step, self.root), json.dumps([parameters, hashes, tools], sort_keys=True, default=str))

        def make(part: Path) -> None:
            """Run the step into ``part``, with its record."""
            self.note(step.name)
            begin = time.perf_counter()
            outputs = {name: part / file for name, file in step.outputs.items()}
            metrics, peak = alone(step.run, inputs, outputs, nice=nice)
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
            (part / RECORD).write_text(json.dumps(record, indent=1, default=str) + "\n", encoding="utf-8")
            self.note(ended(step.name, record["wall_s"]))

        with self._running[step.name]:  # a second one that asks for it waits
            return cached((self.shared if step.shared else self.folder) / f"{step.name}.{key}", make)

    @contextmanager
    def beside(
        self, steps: Sequence[Step[Any]], given: Callable[[], Mapping[str, Path]] | None = None
    ) -> Iterator[None]:
        """Meanwhile run those of ``steps`` whose inputs are complete, one after another; at the end, end what runs.

        Their results are kept and no more: `run` finds them, and runs what failed again. Who begins something else with
        other inputs puts another dict in the place of `paths`, without the results that no longer count. given: files
        that there are by now, of another run, to whose steps these yield the cores.
        """
        ended = Event()

        def work() -> None:
            """Look for the first step that can begin and was not tried."""
            tried, known, own = set[tuple[object, ...]](), self.paths, dict[str, Path]()
            while not ended.wait(LOOK_S):
                if known is not self.paths:
                    known = self.paths
                    tried.clear()
                    own.clear()
                paths = ChainMap(known, own, dict(given()) if given else {})
                for step in steps:
                    asked = step.name, *(paths.get(source) for source in step.inputs.values())
                    if None not in asked and asked not in tried:
                        tried.add(asked)
                        with suppress(Exception):
                            own |= _outputs(step, self._made(step, paths, YIELDING if given else 0))
                        break

        thread = Thread(target=work)
        thread.start()
        try:
            yield
        finally:
            ended.set()
            while thread.is_alive():
                _end_children(thread.name)
                thread.join(LOOK_S)

    def run_all(self, steps: Sequence[Step[Any]]) -> list[Record]:
        """Return the records of ``steps`` in their order.

        A step begins when its inputs are complete: at once if others wait for it, else when a core is free. Raises
        StepError, also for steps that need each other in a cycle.
        """
        import joblib  # not in the process of each step, which imports this file

        made_by = {f"{step.name}.{name}": step.name for step in steps for name in step.outputs}
        needs = {step.name: {made_by[source] for source in step.inputs.values() if source in made_by} for step in steps}
        try:
            TopologicalSorter(needs).prepare()
        except CycleError as error:
            raise StepError(f"steps: {' needs '.join(reversed(error.args[1]))}") from None
        awaited, failed, cores = set().union(*needs.values()), Event(), Semaphore(joblib.cpu_count())
        ended = {step.name: Event() for step in steps}

        def begin(step: Step[Any]) -> None:
            """Wait for the inputs of ``step``, then run it."""
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
        parallel = joblib.Parallel(n_jobs=max(1, len(steps)), backend="threading", batch_size=1)  # pyright: ignore[reportArgumentType]
        try:
            parallel(joblib.delayed(begin)(step) for step in steps)
        except BaseException:
            _end_children()
            raise
        return [self.records[step.name] for step in steps]


def _outputs(step: Step[Any], made: Path) -> dict[str, Path]:
    """Paths of a step's outputs in the folder ``made``, by the name that other steps' inputs give them."""
    return {f"{step.name}.{name}": made / file for name, file in step.outputs.items()}


def _end_children(thread: str | None = None) -> None:
    """End all processes of steps, or those of a thread: their threads would wait for them to the end."""
    for child in multiprocessing.active_children():
        if thread is None or child.name == thread:
            child.terminate()


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
