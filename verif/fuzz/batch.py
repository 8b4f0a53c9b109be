"""A batch of inputs, each a function of (seed, batch, index), decoded within limits; the first failing one is kept."""

import contextlib
import faulthandler
import os
import resource
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from talbot.models.digital.stream import decode_stream
from talbot.verif.fuzz.checks import check_file, check_stream
from talbot.verif.fuzz.host import TARGETS
from talbot.verif.fuzz.streams import Case, Sent, make_case, random_frame

BATCH = 10_000  # inputs of a batch
POOL = 24  # good frames that a batch damages
FILE_EVERY, HOST_EVERY = 50, 5  # one input in 50 goes through files, too; after every fifth one for the host is tried
SECONDS_MAX = 10.0  # of processor time an input
MEMORY_MAX = 512 << 20  # bytes that an input may add to the process
HANG_S = 120  # limit of a group of inputs, at which the process ends with a traceback
GROUP = 256


@dataclass(frozen=True)
class Failure:
    """An input that fails. target: 'decoder' or a name of TARGETS. file: with its bytes, if kept."""

    target: str
    index: int
    kind: str
    file: str | None
    error: str


@dataclass(frozen=True)
class Batch:
    """The result of a batch. inputs, host, files: how many for the decoder, for the host, through files."""

    batch: int
    inputs: int
    host: int
    files: int
    outcomes: dict[str, int]
    kinds: dict[str, int]
    seconds_max: float
    failures: list[Failure]


def generator(seed: int, batch: int, *index: int) -> np.random.Generator:
    """Return the random generator of a batch or of one input."""
    return np.random.default_rng([seed, batch, *index])


def make_pool(seed: int, batch: int) -> list[Sent]:
    """Return the good frames of a batch."""
    rng = generator(seed, batch)
    return [random_frame(rng) for _ in range(POOL)]


def make_input(seed: int, batch: int, index: int, pool: Sequence[Sent] | None = None) -> Case:
    """Return input ``index`` of a batch, which depends on the three numbers alone."""
    return make_case(pool or make_pool(seed, batch), generator(seed, batch, index))


@contextlib.contextmanager
def bounded_memory(extra: int) -> Iterator[None]:
    """Limit the growth of this process's address space, in bytes; beyond it, MemoryError is raised."""
    now = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[0]) * resource.getpagesize()
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    limit = now + extra if hard == resource.RLIM_INFINITY else min(now + extra, hard)
    resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def warm_up(pool: Iterable[Sent]) -> None:
    """Decode the good frames, whole and damaged, so that compilation does not count for an input."""
    for sent in pool:
        for data in (sent.data, sent.data[:-20] + b"\x55" * 20):
            with contextlib.suppress(Exception):  # the inputs will show it
                decode_stream(data, sent.tile)


def try_input(case: Case, through_file: bool) -> tuple[str, float]:
    """Decode one Case; returns ('frames' or 'refused', seconds). Raises Broken or the decoder's exception."""
    start = time.thread_time()
    frames = check_stream(case)
    spent = time.thread_time() - start
    if spent > SECONDS_MAX:
        raise TimeoutError(f"{spent:.1f} s of processor time: at most {SECONDS_MAX} s")
    if through_file:
        check_file(case, frames)
    return "frames" if frames else "refused", spent


def run_batch(seed: int, batch: int, count: int, folder: Path) -> Batch:
    """Try inputs 0..count-1 of a batch. The bytes of the first failure are kept as a file in ``folder``.

    While the batch runs, ``folder``/at.<batch> holds the index of the current input.
    """
    folder.mkdir(parents=True, exist_ok=True)
    pool = make_pool(seed, batch)
    warm_up(pool)
    outcomes, kinds, slowest, files, host = Counter(), Counter(), 0.0, 0, 0
    failures: list[Failure] = []
    names = list(TARGETS)
    with open(folder / f"at.{batch}", "wb", buffering=0) as mark, bounded_memory(MEMORY_MAX):
        for index in range(count):
            if index % GROUP == 0:
                faulthandler.dump_traceback_later(HANG_S, exit=True)
            os.pwrite(mark.fileno(), b"%10d" % index, 0)
            case = make_input(seed, batch, index, pool)
            kinds[case.kind] += 1
            try:
                outcome, spent = try_input(case, index % FILE_EVERY == 0)
                outcomes[outcome] += 1
                slowest = max(slowest, spent)
            except Exception as error:
                failures.append(_keep(error, case, seed, batch, index, None if failures else folder))
            files += index % FILE_EVERY == 0
            if index % HOST_EVERY == 0:
                host += 1
                target = names[index // HOST_EVERY % len(names)]
                try:
                    TARGETS[target](generator(seed, batch, index, 1))
                except Exception as error:
                    failures.append(_failure(target, index, target, error, None))
        faulthandler.cancel_dump_traceback_later()
    (folder / f"at.{batch}").unlink(missing_ok=True)  # a killed run's process may be at the same batch
    return Batch(batch, count, host, files, dict(outcomes), dict(kinds), slowest, failures)


def _failure(target: str, index: int, kind: str, error: Exception, file: Path | None) -> Failure:
    first = str(error).splitlines()[0] if str(error) else ""
    return Failure(target, index, kind, str(file) if file else None, f"{type(error).__name__}: {first}")


def _keep(error: Exception, case: Case, seed: int, batch: int, index: int, folder: Path | None) -> Failure:
    """Return the Failure of a decoder input; its bytes go into ``folder`` if given."""
    file = folder and folder / f"failing-{seed}-{batch}-{index}.bin"
    if file:
        file.write_bytes(case.data)
    return _failure("decoder", index, case.kind, error, file)
