"""Errors that nobody foresaw: one line, where the traceback is, exit status 3; a full disk: which, and what to free.

Standard library only, so that a broken installation is reported, too.
"""

import errno
import os
import shutil
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path

from talbot.base.supervise import lasting_temporary

INTERNAL = 3  # exit status: neither a check that fails (1) nor bad input (2)
ROOM = 64 << 20  # bytes
FULL = {errno.ENOSPC: "no space left", errno.EDQUOT: "your quota is used up"}
REPORT = "please report it with that file (CONTRIBUTING.md says where)"


def reported(program: str, call: Callable[[], int]) -> int:
    """Return the exit status of ``call()``: of an exception INTERNAL, after one line on standard error."""
    try:
        return call()
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package in ("", "talbot"):
            return internal(program, error)
        brings = "make setup-layout, or pip install 'talbot[layout]', brings those of layouts"
        if package in ("optuna", "plotly"):
            brings = "make explore, or pip install 'talbot[explore]', brings it"
        print(f"{program}: error: package = {package}: not installed; {brings}", file=sys.stderr)
        return 2
    except Exception as error:
        return internal(program, error)


def internal(program: str, error: Exception) -> int:
    """Keep the traceback of ``error`` in a file, print one line and return INTERNAL."""
    text = f"{' '.join(map(str, sys.argv))}\nPython {sys.version}\n\n{''.join(traceback.format_exception(error))}"
    words = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    print(f"{program}: error: internal: {words}; {_kept(text)}", file=sys.stderr)
    return INTERNAL


def _kept(text: str) -> str:
    """Write ``text`` to a file in the first writable folder, and return what a user should do with it."""
    here = Path(__file__).parents[2]
    elsewhere = lasting_temporary()
    name = f"talbot-error-{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}.txt"
    for folder in ([here / "build"] if (here / "pyproject.toml").is_file() else []) + [elsewhere]:
        try:
            folder.mkdir(exist_ok=True)
            with (folder / name).open("x", encoding="utf-8", errors="backslashreplace") as file:
                file.write(text)
        except OSError:
            continue
        return f"its traceback is in {folder / name}; {REPORT}"
    print(text, file=sys.stderr)
    return f"its traceback is above: no folder takes a file ({here / 'build'}, {elsewhere})"


def is_full(error: BaseException | None) -> bool:
    """Return whether a full disk or a quota is the cause of ``error``, also in the words of a tool or library."""
    while error:
        if isinstance(error, OSError) and error.errno in FULL:
            return True
        text = str(error)
        if "No space left on device" in text or "Disk quota exceeded" in text:
            return True
        if isinstance(error, OSError) and error.errno is None and "requested and" in text:  # of numpy.ndarray.tofile
            return True
        error = error.__cause__ or error.__context__
    return False


def full(error: BaseException, name: str | None, *folders: Path) -> str:
    """Say what could not be written and what to free.

    name: of the file, where it is known; else it is the error's, else the folder of ``folders`` with least space.
    """
    name = name or os.fsdecode(getattr(error, "filename", None) or "")
    if not name:
        least = min((path.absolute() for path in (*folders, Path(tempfile.gettempdir()))), key=_free)
        # With room in each it is none of these, but where standard output goes
        name = f"{least} ({_free(least) >> 20} MiB free)" if _free(least) < ROOM else "output"
    why = FULL.get(getattr(error, "errno", None) or errno.ENOSPC, FULL[errno.ENOSPC])
    return f"file = {name}: {why}; free some on that disk (make clean removes build/, with results and caches)"


def _free(path: Path) -> int:
    """Bytes that this user may still write where ``path`` is or would be."""
    there = next(p for p in (path, *path.parents) if os.path.lexists(p))
    try:
        return shutil.disk_usage(there).free
    except OSError:
        return sys.maxsize
