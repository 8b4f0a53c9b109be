"""Measurements that may fail without ending the cell."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from talbot.cells.characterize.measured import Failure
from talbot.cells.spice.engine import SimulationError

P = ParamSpec("P")
T = TypeVar("T")


class Tries:
    """Calls whose SimulationError is kept in ``failed``, with its netlist."""

    def __init__(self) -> None:
        self.failed: list[Failure] = []

    def __call__(self, what: str, call: Callable[P, T], *arguments: P.args, **more: P.kwargs) -> T | None:
        """The result of ``call``, None where it failed."""
        try:
            return call(*arguments, **more)
        except SimulationError as error:
            self.failed.append({"what": what, "why": str(error), "deck": error.deck})
            return None
