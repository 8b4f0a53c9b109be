"""Files that are whole or not there: everything is written under a temporary name and renamed."""

import contextlib
import os
import shutil
import tempfile
from pathlib import Path

from models.parameters import ParameterError


def check_folder(field, path):
    """Raise ParameterError unless ``path`` is a folder, or can become one, in which this user may write."""
    path = Path(path)
    there = next(p for p in (path.absolute(), *path.absolute().parents) if os.path.lexists(p))
    if not there.is_dir():
        raise ParameterError(f"{field} = {str(path)!r}: must be a folder; {there} is a file")
    if not os.access(there, os.W_OK | os.X_OK):
        raise ParameterError(f"{field} = {str(path)!r}: must be a folder that you may write")


@contextlib.contextmanager
def staged(out, replaces=()):
    """A temporary folder beside its final names: on success each file in it moves into ``out``.

    replaces: names of files of an earlier run that go then, where this one did not write them again.

    On any error or Ctrl-C the folder is removed and ``out`` stays as it was; an ``out`` that this
    made and left empty is removed too.
    """
    out = Path(out)
    made = not out.exists()
    out.mkdir(parents=True, exist_ok=True)
    part = Path(tempfile.mkdtemp(prefix=".part-", dir=out))
    try:
        yield part
        written = {path.name for path in part.iterdir()}
        for path in sorted(part.iterdir()):
            os.replace(path, out / path.name)
        for name in set(replaces) - written:
            (out / name).unlink(missing_ok=True)
    finally:
        shutil.rmtree(part, ignore_errors=True)
        if made:
            with contextlib.suppress(OSError):
                out.rmdir()


def insert(document, mark, text):
    """Put ``text`` between the comments '<!-- mark -->' and '<!-- end of mark -->' of a Markdown file.

    Raises ParameterError when the file does not have both.
    """
    document = Path(document)
    first, last = f"<!-- {mark} -->\n", f"<!-- end of {mark} -->"
    before, found, rest = document.read_text().partition(first)
    _, ends, after = rest.partition(last)
    if not (found and ends):
        raise ParameterError(f"document = {document}: must have the comments {mark!r} and 'end of {mark}'")
    with staged(document.parent) as part:
        (part / document.name).write_text(f"{before}{first}\n{text.strip()}\n\n{last}{after}")
