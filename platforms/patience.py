"""Cells drawn by c4m-flexcell on a busy machine."""

import asyncio
import contextlib


@contextlib.contextmanager
def patience():
    """c4m-flexcell gives up on a cell after 1 s by the wall clock, which a busy machine exceeds; here after 60 s."""
    wait = asyncio.wait
    asyncio.wait = lambda tasks, timeout: wait(tasks, timeout=60 * timeout)
    try:
        yield
    finally:
        asyncio.wait = wait
