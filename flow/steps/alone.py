"""A call in a process of its own: what it used is measured, and a library that crashes ends no one else."""

import multiprocessing
import resource
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool

from .step import StepError


def alone(call, *arguments):
    """(result, peak memory in MiB of the call or of the largest tool it ran). Exceptions come through."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=context) as pool:
        try:
            return pool.submit(_measured, call, arguments).result()
        except BrokenProcessPool:
            raise StepError(f"{getattr(call, '__qualname__', call)}: its process ended without a word "
                            "(a crash in a library, or no memory left)") from None


def _measured(call, arguments):
    result = call(*arguments)
    kib = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return result, round(kib / 1024)
