"""Keys of kept results, and folders kept under such a key.

Every cache of the project (simulators, cells, layout steps, proofs, mutants, coverage, jobs) names its results with
`digest`: of the code that decides them (`base.sources.code`), of their parameters, of the tools' versions and of the
contents of their input files.
"""

import contextlib
import hashlib
import json
import os
from collections.abc import Callable
from pathlib import Path

from talbot.base.check import work_begins
from talbot.base.files import part_folder

CONTENT = ".content.json"  # digest of each file in a kept folder, and RUNS for a program
RUNS = "+x"


def digest(*parts: object) -> str:
    """Sixteen hexadecimal digits that name what is made from ``parts``.

    A Path is its content: of a file, or of all files below a folder with their names. Anything else is its text.
    """
    h = hashlib.sha256()
    for part in parts:
        for data in _content(part):
            h.update(len(data).to_bytes(8, "big") + data)
    return h.hexdigest()[:16]


def _content(part: object) -> list[bytes]:
    if not isinstance(part, Path):
        return [part if isinstance(part, bytes) else str(part).encode()]
    if not part.is_dir():
        return [part.read_bytes()]
    return [data for name in _names(part) for data in (name.encode(), (part / name).read_bytes())]


def cached(folder: Path | str, make: Callable[[Path], object]) -> Path:
    """Return ``folder`` as ``make(temporary folder)`` filled it, now or earlier; after an exception nothing is left.

    A folder in which a file is missing or changed is made again.
    """
    folder = Path(folder)
    if _sound(folder):
        return folder
    work_begins()
    with part_folder(folder.parent) as part:
        make(part)
        files = {name: _state(part / name) for name in _names(part)}
        (part / CONTENT).write_text(json.dumps(files, indent=0), encoding="utf-8")
        if folder.exists() and not _sound(folder):
            with part_folder(folder.parent) as damaged, contextlib.suppress(FileNotFoundError):
                folder.rename(damaged / folder.name)
        part.chmod(folder.parent.stat().st_mode & 0o777)  # for whoever may read what is beside it
        try:
            part.rename(folder)
        except OSError:  # another process was faster
            if not _sound(folder):
                raise
    return folder


def _names(folder: Path) -> list[str]:
    """Return the files below ``folder`` that count as its content: not what Python keeps next to its modules."""
    files = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return sorted(str(path.relative_to(folder)) for path in files)


def _state(file: Path) -> str:
    """Return the digest of a file, and whether it can be run."""
    return digest(file) + RUNS * os.access(file, os.X_OK)


def _sound(folder: Path) -> bool:
    """Return whether every file that was made in ``folder`` is as it was; what was added later does not count."""
    try:
        files = json.loads((folder / CONTENT).read_text(encoding="utf-8"))
        return all(kept in (state := _state(folder / name), state.removesuffix(RUNS)) for name, kept in files.items())
    except (OSError, ValueError, AttributeError):
        return False
