"""A tar.gz without times, users and paths of the machine that writes it."""

import gzip
import hashlib
import io
import tarfile
from collections.abc import Mapping
from pathlib import Path

TIME = 315532800  # 1980-01-01, the first day that every archiver can store


def archive(path: Path, top: str, files: Mapping[str, bytes]) -> None:
    """Write ``files`` (contents by name) to ``path``, sorted, in the folder ``top`` of the archive."""
    with (
        open(path, "wb") as raw,
        gzip.GzipFile("", "wb", 9, raw, mtime=0) as zipped,
        tarfile.open(fileobj=zipped, mode="w", format=tarfile.USTAR_FORMAT) as tar,
    ):
        for name in sorted(files):
            entry = tarfile.TarInfo(f"{top}/{name}")
            entry.size, entry.mtime, entry.mode = len(files[name]), TIME, 0o644
            tar.addfile(entry, io.BytesIO(files[name]))


def sha256(data: bytes) -> str:
    """Hash of ``data``, hexadecimal."""
    return hashlib.sha256(data).hexdigest()
