"""The foundry's own checks in a PDK that the user has installed (ciel, open_pdks): where they lie under PDK_ROOT."""

import importlib
import os
from dataclasses import dataclass
from pathlib import Path

from models.parameters import ParameterError

PROCESSES = ("sky130",)


@dataclass(frozen=True)
class Foundry:
    """Paths relative to PDK_ROOT. klayout: deck of design rules for KLayout, which reads the variables input, topcell,
    report and ``defines`` (tuple of (name, value)). magic: folder of Magic's technology, rc: the start-up file in it."""

    klayout: str
    defines: tuple
    magic: str
    rc: str


def foundry(pdk):
    """The Foundry of a process; None where none is known."""
    return importlib.import_module(f"platforms.{pdk}.foundry").FOUNDRY if pdk in PROCESSES else None


def installed(pdk, environment=os.environ):
    """dict 'klayout', 'magic' -> Path of what the PDK in the environment's PDK_ROOT has for ``pdk``; {} without one.
    Raises ParameterError where PDK_ROOT has neither."""
    known, root = foundry(pdk), environment.get("PDK_ROOT", "")
    if not root or known is None:
        return {}
    found = {
        name: Path(root) / path
        for name, path in (("klayout", known.klayout), ("magic", known.magic))
        if (Path(root) / path).exists()
    }
    if not found:
        raise ParameterError(
            f"PDK_ROOT = {root}: must hold {known.klayout} or {known.magic}, or not be set: the layout "
            "is then checked by PDKMaster's decks alone"
        )
    return found
