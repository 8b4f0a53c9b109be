"""Files that are whole or not there: everything is written under a temporary name and renamed."""

import contextlib
import os
import shutil
import tempfile
from pathlib import Path


@contextlib.contextmanager
def staged(out):
    """A temporary folder beside its final names: on success each file in it moves into ``out``.

    On any error or Ctrl-C the folder is removed and ``out`` stays as it was; an ``out`` that this
    made and left empty is removed too.
    """
    out = Path(out)
    made = not out.exists()
    out.mkdir(parents=True, exist_ok=True)
    part = Path(tempfile.mkdtemp(prefix=".part-", dir=out))
    try:
        yield part
        for path in sorted(part.iterdir()):
            os.replace(path, out / path.name)
    finally:
        shutil.rmtree(part, ignore_errors=True)
        if made:
            with contextlib.suppress(OSError):
                out.rmdir()
