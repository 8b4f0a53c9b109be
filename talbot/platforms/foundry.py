"""The foundry's own checks in a PDK that the user has installed (ciel, open_pdks), by their paths under PDK_ROOT."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from talbot.models.parameters import ParameterError
from talbot.platforms.processes import package

PROCESSES = ("sky130",)


@dataclass(frozen=True)
class FoundryChecks:
    """Paths relative to PDK_ROOT.

    klayout: deck of design rules for KLayout, which reads the variables input, topcell, report and ``defines`` (name,
    value). magic: folder of Magic's technology; rc: the start-up file in it.
    """

    klayout: str
    defines: tuple[tuple[str, str], ...]
    magic: str
    rc: str


def foundry_checks(pdk: str) -> FoundryChecks | None:
    """Return the foundry's checks of a process; None for one without."""
    return import_module(f"talbot.platforms.{package(pdk)}.foundry").CHECKS if pdk in PROCESSES else None


def installed(pdk: str, environment: Mapping[str, str] = os.environ) -> dict[str, Path]:
    """Path of each of 'klayout' and 'magic' that the PDK in the environment's PDK_ROOT has for ``pdk``; {} without one.

    Raises ParameterError where PDK_ROOT has neither.
    """
    checks, root = foundry_checks(pdk), environment.get("PDK_ROOT", "")
    if not root or checks is None:
        return {}
    found = {
        name: Path(root) / path
        for name, path in (("klayout", checks.klayout), ("magic", checks.magic))
        if (Path(root) / path).exists()
    }
    if not found:
        raise ParameterError(
            f"PDK_ROOT = {root}: must hold {checks.klayout} or {checks.magic}, or not be set: the layout "
            "is then checked by PDKMaster's decks alone"
        )
    return found
