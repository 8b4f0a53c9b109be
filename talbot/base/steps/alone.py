"""A call in a separate process: its memory is measured, a library that crashes ends nothing else, and the end of
this process ends that one and the tools that it runs."""

import ctypes
import multiprocessing
import os
import resource
import signal
import sys
import threading
from collections.abc import Callable
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from types import FrameType
from typing import Any

from talbot.base.steps.step import StepError

ONE_AT_A_TIME = threading.Lock()
PR_SET_PDEATHSIG = 1  # linux/prctl.h: the signal that a process gets when its parent ends


def alone(call: Callable[..., Any], *arguments: Any, nice: int = 0) -> tuple[Any, int]:
    """Return the result of ``call(*arguments)`` and the peak memory, MiB, of it or of the largest tool it ran.

    Its process has the name of the thread that waits for it. nice: by which it yields to others, 0..19. Raises what the
    call raises, and StepError where its process ends without a result.
    """
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(
        target=_measured, args=(sender, nice, call, arguments), name=threading.current_thread().name
    )
    _start(child)
    sender.close()
    try:
        result, peak = receiver.recv()
    except EOFError:
        raise StepError(
            f"{getattr(call, '__qualname__', call)}: its process ended with no result "
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


def _start(child: BaseProcess) -> None:
    """Start with fixed hashes of texts: sets keep their order from run to run, and so do files written from them."""
    with ONE_AT_A_TIME:
        before = os.environ.get("PYTHONHASHSEED")
        os.environ["PYTHONHASHSEED"] = "0"
        try:
            child.start()
        finally:
            del os.environ["PYTHONHASHSEED"]
            if before is not None:
                os.environ["PYTHONHASHSEED"] = before


def _measured(sender: Connection, nice: int, call: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
    os.nice(nice)
    signal.signal(signal.SIGTERM, _end)
    _end_with_parent()
    try:
        result = call(*arguments)
    except Exception as error:
        result = error
    _end_workers()
    peak = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    sender.send((result, round(peak / (1 << 20 if sys.platform == "darwin" else 1 << 10))))  # bytes there, else KiB


def _end_with_parent() -> None:
    """Let SIGTERM come to this process when its parent ends: by the kernel, or by a thread that looks (macOS)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
        return
    parent = multiprocessing.parent_process()

    def wait() -> None:
        if parent:
            parent.join()
            os.kill(os.getpid(), signal.SIGTERM)

    threading.Thread(target=wait, daemon=True).start()


def _end_workers() -> None:
    """End joblib's idle workers, for which the end of this process would wait five minutes."""
    if "joblib.externals.loky" in sys.modules:
        from joblib.externals.loky import get_reusable_executor

        # joblib has no types
        get_reusable_executor(reuse=True).shutdown(kill_workers=True)  # pyright: ignore[reportArgumentType]


def _end(signum: int, frame: FrameType | None) -> None:
    """Raise an exception, so that what runs in base.tools ends its tool."""
    raise SystemExit(128 + signum)
