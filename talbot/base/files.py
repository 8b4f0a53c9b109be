"""Files that are complete or absent: everything is written under a temporary name and renamed."""

import contextlib
import errno
import fcntl
import os
import platform
import secrets
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from talbot.base.check import work_begins
from talbot.base.failure import FULL
from talbot.base.supervise import undisturbed, writing
from talbot.models.parameters import ParameterError

PART = f".part-{platform.node()}-"  # then the process, so that a killed one's leftovers are recognized


def check_folder(field: str, path: Path | str, names: Iterable[str] = ()) -> None:
    """Raise ParameterError unless ``path`` is, or can become, a folder in which this user may write files ``names``."""
    path = Path(path)
    with contextlib.suppress(FileNotFoundError, NotADirectoryError):
        try:
            path.lstat()
        except OSError as error:
            if error.errno == errno.ENAMETOOLONG:
                raise ParameterError(f"{field} = {str(path)!r}: must be a shorter name") from None
            raise
    existing = next(p for p in (path.absolute(), *path.absolute().parents) if os.path.lexists(p))
    if not existing.is_dir():
        raise ParameterError(f"{field} = {str(path)!r}: must be a folder; {existing} is a file")
    try:  # more than the permissions decide: /proc, a medium that is read-only
        with part_folder(existing):
            pass
    except OSError as error:
        raise ParameterError(
            f"{field} = {str(path)!r}: must be a folder that you may write ({error.strerror})"
        ) from None
    _check_names(path, names)


def check_file(field: str, path: Path) -> None:
    """Raise ParameterError unless ``path`` is, or can become, a file that this user may write."""
    if path.is_dir():
        raise ParameterError(f"{field} = {str(path)!r}: must be a file, not a folder")
    if not path.exists() or path.is_file():
        check_folder(field, path.parent)


@contextlib.contextmanager
def part_folder(folder: Path) -> Iterator[Path]:
    """Yield a temporary folder in ``folder``, removed at the end; leftovers of killed processes are removed, too."""
    part = folder / f"{PART}{os.getpid()}-{secrets.token_hex(4)}"
    writing(part)
    folder.mkdir(parents=True, exist_ok=True)
    for left in folder.glob(f"{PART}*"):
        if not _alive(int(left.name.removeprefix(PART).partition("-")[0])):
            shutil.rmtree(left, ignore_errors=True)
    part.mkdir(mode=0o700, parents=True)  # where a run that failed has removed the folder meanwhile
    try:
        yield part
    except OSError as error:
        if error.errno in FULL and not error.filename:  # of a write: which file it was is not in it
            error.filename = str(folder)
        raise
    finally:
        shutil.rmtree(part, ignore_errors=True)


@contextlib.contextmanager
def staged(out: Path | str, replaces: Iterable[str] = ()) -> Iterator[Path]:
    """Yield a temporary folder; on success all files and folders in it move into ``out``, or none.

    replaces: names of an earlier run's files that are removed where this run did not write them again. On any error or
    signal ``out`` stays as it was; an ``out`` that was created here and is empty is removed. Raises ParameterError
    where a folder has a file's name, at once for the names in ``replaces``.
    """
    work_begins()
    out, replaces = Path(out), set(replaces)
    is_new = not out.exists()
    _check_names(out, replaces)
    try:
        with part_folder(out) as part:
            new, old = part / "new", part / "old"
            new.mkdir()
            yield new
            written = {path.name for path in new.iterdir()}
            _check_names(out, [name for name in written if not (new / name).is_dir()])
            old.mkdir()
            with undisturbed(), held(out):
                _exchange(out, new, old, sorted(written), sorted(replaces - written))
    finally:
        if is_new:
            with contextlib.suppress(OSError):
                out.rmdir()


@contextlib.contextmanager
def held(folder: Path) -> Iterator[None]:
    """Let other processes wait that hold ``folder``, too: of files that appear together, those of one process do."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with contextlib.suppress(OSError):  # of a file system without locks
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def _check_names(out: Path, names: Iterable[str]) -> None:
    for name in sorted(names):
        if (out / name).is_dir() and not (out / name).is_symlink():
            raise ParameterError(f"out = {str(out)!r}: must not have a folder {name}, which is the name of a result")


def _exchange(out: Path, new: Path, old: Path, written: Iterable[str], gone: Iterable[str]) -> None:
    """Move ``written`` from ``new`` to ``out`` and those of these names, and ``gone``, from there to ``old``.

    Where one cannot be moved, all go back.
    """
    moves = [(out / name, old / name) for name in (*written, *gone) if os.path.lexists(out / name)]
    moves += [(new / name, out / name) for name in written]
    done = []
    try:
        for source, target in moves:
            os.rename(source, target)
            done.append((source, target))
    except BaseException:
        for source, target in reversed(done):
            os.rename(target, source)
        raise


@contextlib.contextmanager
def atomic(path: Path | str) -> Iterator[Path]:
    """Yield a temporary path whose file becomes ``path`` on success; the folder of ``path`` is created."""
    work_begins()
    path = Path(path)
    if path.exists() and not path.is_file():  # a device or a pipe, /dev/stdout: written to, not replaced
        with tempfile.TemporaryDirectory() as folder:
            yield Path(folder) / path.name
            path.write_bytes((Path(folder) / path.name).read_bytes())
        return
    with part_folder(path.parent) as part:
        yield part / path.name
        os.replace(part / path.name, path)


def write(path: Path | str, data: str | bytes) -> None:
    """Write ``data`` to the file ``path`` atomically."""
    with atomic(path) as part:
        part.write_bytes(data.encode() if isinstance(data, str) else data)


def insert(document: Path | str, mark: str, text: str) -> None:
    """Replace what is between the comments '<!-- mark -->' and '<!-- end of mark -->' of a Markdown file by ``text``.

    Raises ParameterError when the file does not have both.
    """
    before, first, last, after = marked(document, mark)
    write(document, f"{before}{first}\n{text.strip()}\n\n{last}{after}")


def marked(document: Path | str, mark: str) -> tuple[str, str, str, str]:
    """The text before such a place, both comments, the text after. Raises ParameterError as `insert`, OSError."""
    first, last = f"<!-- {mark} -->\n", f"<!-- end of {mark} -->"
    try:
        before, opening, rest = Path(document).read_text(encoding="utf-8").partition(first)
    except UnicodeDecodeError:
        raise ParameterError(f"document = {document}: must be a text file") from None
    _, ends, after = rest.partition(last)
    if not (opening and ends):
        raise ParameterError(f"document = {document}: must have the comments {mark!r} and 'end of {mark}'")
    return before, first, last, after


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True
