"""Folders that are expensive to make, kept by name: whole, or not there."""

import hashlib
import os
import platform
import shutil
import tempfile
from pathlib import Path

PART = f".part-{platform.node()}-"  # then its process, so that it is known whose it is, should it stay


def digest(*parts):
    """A name for what is made from ``parts`` (bytes, or anything with a text): 16 hexadecimal digits."""
    h = hashlib.sha256()
    for part in parts:
        h.update(part if isinstance(part, bytes) else str(part).encode())
        h.update(b"\0")
    return h.hexdigest()[:16]


def cached(folder, make):
    """``folder`` as ``make(temporary folder)`` filled it, now or earlier; on any exception nothing is left of it, and
    what a process that was killed left beside it goes, too."""
    folder = Path(folder)
    if folder.exists():
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    _sweep(folder.parent)
    part = Path(tempfile.mkdtemp(prefix=f"{PART}{os.getpid()}-", dir=folder.parent))
    try:
        make(part)
        try:
            part.rename(folder)
        except OSError:  # another process was faster
            if not folder.exists():
                raise
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return folder


def _sweep(folder):
    for part in folder.glob(f"{PART}*"):
        if not _lives(int(part.name.rsplit("-", 2)[1])):
            shutil.rmtree(part, ignore_errors=True)


def _lives(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True
