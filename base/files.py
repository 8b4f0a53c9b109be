"""Files that are complete or absent: everything is written under a temporary name and renamed."""

import contextlib
import os
import platform
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from models.parameters import ParameterError

PART = f".part-{platform.node()}-"  # then the process, so that a killed one's leftovers are recognized


def check_folder(field: str, path: Path | str) -> None:
    """Raise ParameterError unless ``path`` is, or can become, a folder in which this user may write."""
    path = Path(path)
    there = next(p for p in (path.absolute(), *path.absolute().parents) if os.path.lexists(p))
    if not there.is_dir():
        raise ParameterError(f"{field} = {str(path)!r}: must be a folder; {there} is a file")
    if not os.access(there, os.W_OK | os.X_OK):
        raise ParameterError(f"{field} = {str(path)!r}: must be a folder that you may write")


@contextlib.contextmanager
def part_folder(folder: Path) -> Iterator[Path]:
    """Yield a temporary folder in ``folder``, removed at the end; what killed processes left there goes, too."""
    folder.mkdir(parents=True, exist_ok=True)
    for left in folder.glob(f"{PART}*"):
        if not _alive(int(left.name.removeprefix(PART).partition("-")[0])):
            shutil.rmtree(left, ignore_errors=True)
    part = Path(tempfile.mkdtemp(prefix=f"{PART}{os.getpid()}-", dir=folder))
    try:
        yield part
    finally:
        shutil.rmtree(part, ignore_errors=True)


@contextlib.contextmanager
def staged(out: Path | str, replaces: Iterable[str] = ()) -> Iterator[Path]:
    """Yield a temporary folder; on success each file in it moves into ``out``.

    replaces: names of an earlier run's files that are removed where this run did not write them again. On any error or
    Ctrl-C ``out`` stays as it was; an ``out`` that was created here and is empty is removed.
    """
    out = Path(out)
    made = not out.exists()
    try:
        with part_folder(out) as part:
            yield part
            written = {path.name for path in part.iterdir()}
            for path in sorted(part.iterdir()):
                os.replace(path, out / path.name)
            for name in set(replaces) - written:
                (out / name).unlink(missing_ok=True)
    finally:
        if made:
            with contextlib.suppress(OSError):
                out.rmdir()


@contextlib.contextmanager
def atomic(path: Path | str) -> Iterator[Path]:
    """Yield a temporary path whose file becomes ``path`` on success; the folder of ``path`` is created."""
    path = Path(path)
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
    document = Path(document)
    first, last = f"<!-- {mark} -->\n", f"<!-- end of {mark} -->"
    before, found, rest = document.read_text().partition(first)
    _, ends, after = rest.partition(last)
    if not (found and ends):
        raise ParameterError(f"document = {document}: must have the comments {mark!r} and 'end of {mark}'")
    write(document, f"{before}{first}\n{text.strip()}\n\n{last}{after}")


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True
