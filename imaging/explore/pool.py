"""Calls in other processes: what raises, hangs or dies is tried again, then reported, and no other call is lost.

By loky's processes here, or by a Dask cluster where SCHEDULER=tcp://host:port is set, as `base.jobs` has it.
"""

import importlib
import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ALL_COMPLETED, FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from time import monotonic
from typing import Any, NamedTuple, Self

from joblib.executor import get_memmapping_executor

from talbot.base.check import work_begins
from talbot.base.jobs import restarts
from talbot.models.parameters import ParameterError

TRIES = 2
IDLE = 300  # s that processes wait for calls
TICK = 1.0  # s between two looks at the clock


@dataclass(frozen=True)
class Failure:
    """A call that did not return in `TRIES` tries, and why the last did not."""

    reason: str


class _Call(NamedTuple):
    """A call that waits or runs. alone: one before it ended the processes, so it runs while no other does."""

    number: int
    tries: int = 0
    alone: bool = False


class Pool:
    """Processes for calls. workers: of this machine, -1 for all cores. seconds: that a call may take."""

    def __init__(self, workers: int = 1, seconds: float = 3600.0) -> None:
        work_begins()
        self.workers, self.seconds = workers if workers > 0 else os.cpu_count() or 1, seconds
        self.scheduler = os.environ.get("SCHEDULER", "")
        self._client: Any = None
        self._executor: Executor | None = None

    def __enter__(self) -> Self:
        self._executor = self._start()
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: Any) -> None:
        if kind:
            self._end()  # else the processes wait for the next calls
        if self._client is not None:
            self._client.close()

    def run(self, call: Callable[..., Any], arguments: Sequence[tuple[Any, ...]]) -> Iterator[tuple[int, Any]]:
        """Pairs of a number in ``arguments`` and what ``call(*arguments[number])`` returns, or a Failure."""
        todo = deque(_Call(number) for number in range(len(arguments)))
        running: dict[Future[Any], tuple[_Call, float]] = {}
        self._warm(call.__module__)
        while todo or running:
            broken = False
            while todo and len(running) < self._places and not any(c.alone for c, _ in running.values()):
                if todo[0].alone and running:
                    break
                next_call = todo.popleft()
                assert self._executor is not None
                try:
                    with restarts():
                        future = self._executor.submit(call, *arguments[next_call.number])
                except BrokenExecutor:  # a process has died meanwhile: the calls that run say so
                    todo.appendleft(next_call)
                    broken = True
                    break
                running[future] = next_call, monotonic()
            done, _ = wait(running, TICK, ALL_COMPLETED if broken else FIRST_COMPLETED)
            for future in done:
                ended, _ = running.pop(future)
                error = None if future.cancelled() else future.exception()
                if not future.cancelled() and error is None:
                    yield ended.number, future.result()
                    continue
                died = _is_death(error)
                broken |= died
                again = ended._replace(tries=ended.tries + (ended.alone or not died), alone=died)
                yield from self._again(again, todo, _words(error))
            late = [future for future, (_, start) in running.items() if monotonic() - start > self.seconds]
            for future in late:
                ended, _ = running.pop(future)
                future.cancel()
                again = ended._replace(tries=ended.tries + 1)
                yield from self._again(again, todo, f"timeout: longer than {self.seconds:g} s")
            if broken or late:
                todo.extendleft(interrupted for interrupted, _ in running.values())
                running.clear()
                self._end()
                self._executor = self._start()
                self._warm(call.__module__)

    def _again(self, ended: _Call, todo: deque[_Call], reason: str) -> Iterator[tuple[int, Failure]]:
        if ended.tries < TRIES:
            todo.append(ended)
        else:
            yield ended.number, Failure(reason)

    @property
    def _places(self) -> int:
        """Calls that run at a time; a cluster's workers come and go."""
        if self._client is None:
            return self.workers
        return max(
            1, sum(worker["nthreads"] for worker in self._client.scheduler_info(n_workers=-1)["workers"].values())
        )

    def _start(self) -> Executor:
        if not self.scheduler:
            return get_memmapping_executor(self.workers, timeout=IDLE)  # joblib's, which it uses again, too
        if self._client is None:
            try:
                from distributed import Client

                self._client = Client(self.scheduler, timeout="10s")
            except (OSError, ValueError) as error:
                raise ParameterError(
                    f"SCHEDULER = {self.scheduler!r}: no Dask scheduler answers there ({error})"
                ) from None
        return self._client.get_executor(pure=False)

    def _warm(self, module: str) -> None:
        """Import ``module`` in the processes here, so that it is in the time of no call."""
        if self._client is None and self._executor is not None:
            try:
                wait([self._executor.submit(_imported, module) for _ in range(self.workers)])
            except BrokenExecutor:  # a process that waited was killed
                self._end()
                self._executor = self._start()

    def _end(self) -> None:
        """End the processes here, what they run too; a cluster's go on, and what they return is not waited for."""
        if self._client is None and self._executor is not None:
            self._executor.shutdown(wait=True, kill_workers=True)  # pyright: ignore[reportCallIssue]


def _imported(module: str) -> None:
    importlib.import_module(module)


def _is_death(error: BaseException | None) -> bool:
    """Whether a process ended, and not a call: loky's and Dask's words for it."""
    return any(kind.__name__ in ("BrokenProcessPool", "KilledWorker", "BrokenExecutor") for kind in type(error).__mro__)


def _words(error: BaseException | None) -> str:
    if error is None:
        return "cancelled"
    if _is_death(error):
        return "its process died (killed, or out of memory)"
    return " ".join(f"{type(error).__name__}: {error}".split())[:300]
