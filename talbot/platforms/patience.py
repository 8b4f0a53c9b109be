"""Cells drawn by c4m-flexcell on a busy machine: by a library, and by PDKMaster's processes when they are imported."""

import asyncio
import contextlib
import importlib
import sys
from collections.abc import Iterator
from types import ModuleType
from typing import Any


@contextlib.contextmanager
def patience() -> Iterator[None]:
    """Let c4m-flexcell give up on a cell after 60 s instead of 1 s of wall clock, which a busy machine exceeds.

    It leaves its event loop open, so it gets one that is closed here.
    """
    library: Any = asyncio
    wait = library.wait
    library.wait = lambda tasks, timeout: wait(tasks, timeout=60 * timeout)
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    try:
        yield
    finally:
        library.wait = wait
        asyncio.set_event_loop(None)
        loop.close()


def imported(module: str) -> ModuleType:
    """Import a module of a PDKMaster process, which may draw cells.

    The package of SKY130 imports its pads, which draws their clamps for seconds; only who asks for the pads gets them.
    """
    pads = f"{'.'.join(module.split('.')[:3])}.io"
    with patience():
        if module == pads or pads in sys.modules:
            return importlib.import_module(module)
        sys.modules[pads] = without = ModuleType(pads)
        without.__all__ = []  # pyright: ignore[reportAttributeAccessIssue]
        try:
            return importlib.import_module(module)
        finally:
            del sys.modules[pads]
