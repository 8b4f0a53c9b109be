"""A call in a process of its own: what it used is measured, a library that crashes ends no one else, and the end of
this process is the end of that one and of the tools that it runs."""

import ctypes
import multiprocessing
import os
import resource
import signal
import sys
import threading

from .step import StepError

ONE_AT_A_TIME = threading.Lock()
PR_SET_PDEATHSIG = 1  # linux/prctl.h: the signal that a process gets when its parent ends


def alone(call, *arguments):
    """(result, peak memory in MiB of the call or of the largest tool it ran). Exceptions come through."""
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=_measured, args=(sender, call, arguments))
    _start(child)
    sender.close()
    try:
        result, peak = receiver.recv()
    except EOFError:
        raise StepError(
            f"{getattr(call, '__qualname__', call)}: its process ended without a word "
            "(a crash in a library, or no memory left)"
        ) from None
    except BaseException:
        child.terminate()
        raise
    finally:
        receiver.close()
        child.join()
    if isinstance(result, BaseException):
        raise result
    return result, peak


def _start(child):
    """With fixed hashes of texts: sets have the same order each time, and what is written from them is the same file."""
    with ONE_AT_A_TIME:
        before = os.environ.get("PYTHONHASHSEED")
        os.environ["PYTHONHASHSEED"] = "0"
        try:
            child.start()
        finally:
            del os.environ["PYTHONHASHSEED"]
            if before is not None:
                os.environ["PYTHONHASHSEED"] = before


def _measured(sender, call, arguments):
    signal.signal(signal.SIGTERM, _end)
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    try:
        result = call(*arguments)
    except Exception as error:
        result = error
    _send_workers_home()
    kib = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    sender.send((result, round(kib / 1024)))


def _send_workers_home():
    """The end of this process would wait for joblib's idle workers, five minutes."""
    if "joblib.externals.loky" in sys.modules:
        from joblib.externals.loky import get_reusable_executor

        get_reusable_executor(reuse=True).shutdown(kill_workers=True)


def _end(signum, frame):
    """As an exception, so that what runs in base.tools ends its tool."""
    raise SystemExit(128 + signum)
