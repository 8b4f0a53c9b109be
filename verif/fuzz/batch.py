"""A batch of inputs: each made from (seed, batch, index) alone, decoded within its limits, the first bad one kept."""

import contextlib
import faulthandler
import os
import resource
import time
from collections import Counter
from pathlib import Path

import numpy as np

from models.digital.stream import decode_stream

from .checks import check_file, check_stream
from .host import TARGETS
from .streams import make_case, random_frame

BATCH = 10_000  # inputs of a batch
POOL = 24  # good frames that a batch damages
FILE_EVERY, HOST_EVERY = 50, 5  # every so many inputs one goes through files too; one for the host is tried
SECONDS_MAX = 10.0  # of processor time an input
MEMORY_MAX = 512 << 20  # bytes that an input may add to the process
HANG_S = 120  # and a group of GROUP inputs may take no longer: the process ends with a traceback
GROUP = 256


def generator(seed, batch, *index):
    return np.random.default_rng([seed, batch, *index])


def make_pool(seed, batch):
    """The good frames of a batch: list of Sent."""
    rng = generator(seed, batch)
    return [random_frame(rng) for _ in range(POOL)]


def make_input(seed, batch, index, pool=None):
    """Input ``index`` of a batch: Case, the same wherever and whenever it is made."""
    return make_case(pool or make_pool(seed, batch), generator(seed, batch, index))


@contextlib.contextmanager
def bounded_memory(extra):
    """What this process may add to its address space, bytes: beyond it, MemoryError."""
    now = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    limit = now + extra if hard == resource.RLIM_INFINITY else min(now + extra, hard)
    resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def warm_up(pool):
    """Decode the good frames, whole and damaged: what is compiled or read at the first call is no input's memory."""
    for sent in pool:
        for data in (sent.data, sent.data[:-20] + b"\x55" * 20):
            with contextlib.suppress(Exception):  # the inputs will tell
                decode_stream(data, sent.tile)


def try_input(case, through_file):
    """Decode one Case; returns ('frames' or 'refused', seconds). Raises Broken or whatever the decoder raised."""
    start = time.thread_time()
    frames = check_stream(case)
    spent = time.thread_time() - start
    if spent > SECONDS_MAX:
        raise TimeoutError(f"{spent:.1f} s of processor time: at most {SECONDS_MAX} s")
    if through_file:
        check_file(case, frames)
    return "frames" if frames else "refused", spent


def run_batch(seed, batch, count, folder):
    """Try inputs 0..count-1 of a batch: dict inputs, host, files, outcomes, kinds, seconds_max, failures.

    failures: list of {target, index, kind, error, file}, of which the first one's bytes are kept as a file in
    ``folder``. While it runs, the input under way stands in ``folder``/at.<batch>.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    pool = make_pool(seed, batch)
    warm_up(pool)
    outcomes, kinds, failures, slowest, files, host = Counter(), Counter(), [], 0.0, 0, 0
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
                    failures.append(_told(target, index, target, error, None))
        faulthandler.cancel_dump_traceback_later()
    (folder / f"at.{batch}").unlink(missing_ok=True)  # a killed run's process may be at the same batch
    return {
        "batch": batch,
        "inputs": count,
        "host": host,
        "files": files,
        "outcomes": dict(outcomes),
        "kinds": dict(kinds),
        "seconds_max": slowest,
        "failures": failures,
    }


def _told(target, index, kind, error, file):
    return {
        "target": target,
        "index": index,
        "kind": kind,
        "file": file and str(file),
        "error": f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}",
    }


def _keep(error, case, seed, batch, index, folder):
    """A failure's record; its bytes go into ``folder`` if there is one."""
    file = folder and folder / f"failing-{seed}-{batch}-{index}.bin"
    if file:
        file.write_bytes(case.data)
    return _told("decoder", index, case.kind, error, file)
