"""Modules of a process by its name."""

import importlib
from collections.abc import Sequence
from types import ModuleType

from models.parameters import ParameterError

PROCESSES = "sky130", "ihp-sg13g2"


def module(pdk: str, name: str, known: Sequence[str] = PROCESSES, use: str = "") -> ModuleType:
    """The module platforms/<pdk>/<name>.py. Raises ParameterError for a process that is not in ``known``."""
    if pdk not in known:
        raise ParameterError(f"pdk = {pdk!r}: must be one of {', '.join(known)}{use}")
    return importlib.import_module(f"platforms.{pdk.replace('-', '_')}.{name}")
