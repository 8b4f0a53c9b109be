"""Bytes with their digest behind them, which shows whether a file is damaged."""

import hashlib

DIGEST = hashlib.sha256().digest_size


def sealed(data: bytes) -> bytes:
    """Return ``data`` and its digest; a pickle in it can be read as it is."""
    return data + hashlib.sha256(data).digest()


def unsealed(data: bytes) -> memoryview | None:
    """Return what `sealed` was given, None where the file is not whole or a byte of it is another."""
    view = memoryview(data)
    return view[:-DIGEST] if hashlib.sha256(view[:-DIGEST]).digest() == view[-DIGEST:] else None
