"""What a kept result's key is made of, and folders that are expensive to make, kept under that key.

Every cache of the project (simulators, cells, layout steps, proofs, mutants, coverage, jobs) names its results with
`digest`: of the code that decides them (`base.sources.code`), of their parameters, of the tools' versions and of the
contents of their input files.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path

from .files import part_folder


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
    files = sorted(path for path in part.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return [data for path in files for data in (str(path.relative_to(part)).encode(), path.read_bytes())]


def cached(folder: Path | str, make: Callable[[Path], object]) -> Path:
    """Return ``folder`` as ``make(temporary folder)`` filled it, now or earlier; after an exception nothing is left."""
    folder = Path(folder)
    if folder.exists():
        return folder
    with part_folder(folder.parent) as part:
        make(part)
        try:
            part.rename(folder)
        except OSError:  # another process was faster
            if not folder.exists():
                raise
    return folder
