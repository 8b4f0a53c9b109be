"""Folders that are expensive to make, kept by name: whole, or not there."""

import hashlib
import os
import shutil
import tempfile
from pathlib import Path


def digest(*parts):
    """A name for what is made from ``parts`` (bytes, or anything with a text): 16 hexadecimal digits."""
    h = hashlib.sha256()
    for part in parts:
        h.update(part if isinstance(part, bytes) else str(part).encode())
        h.update(b"\0")
    return h.hexdigest()[:16]


def cached(folder, make):
    """``folder`` as ``make(temporary folder)`` filled it, now or earlier; on any exception nothing is left of it."""
    folder = Path(folder)
    if folder.exists():
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    part = Path(tempfile.mkdtemp(prefix=f".part-{os.getpid()}-", dir=folder.parent))     # whose it is, should it stay
    try:
        make(part)
        try:
            part.rename(folder)
        except OSError:             # another process was faster
            if not folder.exists():
                raise
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return folder
