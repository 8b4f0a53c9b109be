"""A program in a child process, so that SIGINT, SIGTERM and SIGHUP end it at any moment and leave nothing behind.

The parent waits. At a signal it kills every process below it (tools in separate sessions too), removes what was
being written, and exits with 128 + the signal's number. No code of the program is interrupted, so none of it has to be
ready for that; where files must appear together, `undisturbed` lets the end wait.
"""

import contextlib
import ctypes
import fcntl
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

RUN = "TALBOT_RUN"  # the environment's name of the run's folder: temporary files, and the two files below
WRITTEN, LOCK = "written", "lock"
ENDS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP
SET_CHILD_SUBREAPER = 36  # linux/prctl.h: processes whose parent ended become this one's
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3  # malloc.h
PATIENCE = 10.0  # s that files may take to appear


def supervised(program: Callable[[], int]) -> int:
    """Return the exit status of ``program``, run in a child; 128 + the number of the signal that ended it.

    Inside a supervised run: the program's status, run here. A signal that this process ignores (nohup) is left ignored.
    """
    if _run():
        signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDS)
        return program()
    ends = {number for number in ENDS if signal.getsignal(number) != signal.SIG_IGN}
    signal.pthread_sigmask(signal.SIG_BLOCK, {*ends, signal.SIGCHLD})
    folder = Path(tempfile.mkdtemp(prefix="talbot-"))
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(SET_CHILD_SUBREAPER, 1)
    parent = os.getpid()
    child = os.fork()
    if not child:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # of a terminal, it comes to the whole group
        for number in ends - {signal.SIGINT}:
            signal.signal(number, _passed_on(parent))  # and is the default again in what is started
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {*ENDS, signal.SIGCHLD})
        os.environ |= {RUN: str(folder), "TMPDIR": str(folder)}
        tempfile.tempdir = None
        keep_freed_memory()
        return program()
    number, status = _end_of(child, ends)
    if number:
        _wait_for_files(folder)
    _kill_all(patience=0 if number else 1)
    if number:
        _remove_written(folder)
        line = "interrupted" if number == signal.SIGINT else f"ended by {signal.Signals(number).name}"
        clear = "\r\x1b[K" if sys.stderr.isatty() else ""
        print(f"{clear}talbot: error: {line}; nothing was left half-written", file=sys.stderr)
    shutil.rmtree(folder, ignore_errors=True)
    return 128 + number if number else status


def keep_freed_memory() -> None:
    """Let this process use memory again that it freed, up to 256 MB, instead of asking the kernel for clean pages.

    A third of the time of work on arrays of some MB. Where the C library is not glibc nothing changes.
    """
    with contextlib.suppress(AttributeError):
        change = ctypes.CDLL(None).mallopt
        change(M_MMAP_THRESHOLD, 32 << 20)  # the largest that glibc takes
        change(M_TRIM_THRESHOLD, 256 << 20)


def _passed_on(parent: int) -> Callable[[int, object], None]:
    """End a child silently: the signal goes to its parent, which kills it.

    A worker that the signal ended, too, is no error.
    """

    def handler(number: int, _: object) -> None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        if os.getppid() == parent:
            os.kill(parent, number)

    return handler


@contextlib.contextmanager
def undisturbed() -> Iterator[None]:
    """Let the end of the run wait while files appear together. Not to be nested."""
    folder = _run()
    if not folder:
        yield
        return
    with (folder / LOCK).open("ab") as lock:
        fcntl.flock(lock, fcntl.LOCK_SH)
        yield


def writing(folder: Path) -> None:
    """Note a folder that is about to be made: at the run's end by a signal it goes with all that is in it.

    Folders above it that do not exist yet go where they are empty then.
    """
    run = _run()
    if run:
        new = [path for path in folder.absolute().parents if not path.exists()]
        with (run / WRITTEN).open("ab") as file:
            file.write(b"".join(os.fsencode(path) + b"\0" for path in [*new, folder.absolute()]) + b"\0")


def lasting_temporary() -> Path:
    """Return the folder of temporary files that outlive a run, whose files are in a folder there that goes with it."""
    run = os.environ.get(RUN)
    return Path(run).parent if run else Path(tempfile.gettempdir())


def _run() -> Path | None:
    name = os.environ.get(RUN)
    return Path(name) if name and os.path.isdir(name) else None


def _end_of(child: int, ends: set[signal.Signals]) -> tuple[int, int]:
    """Wait: (the signal that came, or that killed the child, or 0, status of the child)."""
    while True:
        number = signal.sigwait({*ends, signal.SIGCHLD})
        if number != signal.SIGCHLD:
            return number, 0
        while (found := _reaped()) is not None:
            if found[0] == child:
                code = os.waitstatus_to_exitcode(found[1])
                return max(0, -code), max(0, code)


def _reaped() -> tuple[int, int] | None:
    """Return a child that ended and its status; None where none has."""
    try:
        found = os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        return None
    return found if found[0] else None


def _wait_for_files(folder: Path) -> None:
    """Hold the lock of `undisturbed`, up to PATIENCE; it is let go when this process ends."""
    lock = os.open(folder / LOCK, os.O_CREAT | os.O_WRONLY)
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        with contextlib.suppress(BlockingIOError):
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        time.sleep(0.005)


def _kill_all(patience: float) -> None:
    """Kill all processes below this one, those that do not end by themselves in ``patience`` s.

    All are stopped first: who runs on while the others are listed may start one more, which is lost where its parent
    ends (`_below`).
    """
    end, stopped = time.monotonic() + patience, set[int]()
    while True:
        while _reaped():
            pass
        below = _below(os.getpid())
        if not below:
            return
        if time.monotonic() >= end:
            running = set(below) - stopped
            for process in running or below:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGSTOP if running else signal.SIGKILL)
            stopped |= running
        time.sleep(0.002)


def _below(top: int) -> list[int]:
    """Every process below ``top``. Elsewhere than on Linux, not those whose parent has ended."""
    children: dict[int, list[int]] = {}
    for process, parent in _parents():
        children.setdefault(parent, []).append(process)
    found = [top]
    for process in found:
        found += children.get(process, [])
    return found[1:]


def _parents() -> Iterator[tuple[int, int]]:
    """Every process and its parent: from /proc, or by ps where there is none (macOS), without that itself."""
    if sys.platform == "linux":
        for path in Path("/proc").glob("[0-9]*/stat"):
            with contextlib.suppress(OSError):  # it has ended
                yield (
                    int(path.parent.name),
                    int(path.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()[1]),
                )
        return
    with subprocess.Popen(["ps", "-axo", "pid=,ppid="], stdout=subprocess.PIPE, encoding="utf-8") as ps:
        lines, _ = ps.communicate()
    for process, parent in (map(int, line.split()) for line in lines.splitlines()):
        if process != ps.pid:
            yield process, parent


def _remove_written(run: Path) -> None:
    with contextlib.suppress(FileNotFoundError):
        groups = os.fsdecode((run / WRITTEN).read_bytes()).split("\0\0")
        for group in reversed([group.split("\0") for group in groups if group]):
            *new, folder = map(Path, group)
            shutil.rmtree(folder, ignore_errors=True)
            for path in new:
                with contextlib.suppress(OSError):
                    path.rmdir()
