"""Settings of ngspice for the circuit of a row, and those tried after a failure."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

from talbot.models.parameters import check_choice, check_real

METHODS = ("trap", "gear")
BODIES = re.compile(r"\brbodymod *= *1(\.0)?\b")


@dataclass(frozen=True)
class Accuracy:
    """Tolerances of ngspice; with these decisions are within 10 ps of a reference's (docs/decisions/0004-cosim.md).

    Attributes
    ----------
    reltol, trtol : float
        Of the solution, 1e-8..0.1, and of the time step, 0.1..100.
    chgtol, abstol : float
        Charge (C) and current (A) below which neither counts, 1e-20..1e-12 each.
    method : str
        trap or gear.
    step : float
        Longest time step, 1e-12..1e-6 s.
    gmin : float
        Conductance across every junction, 1e-16..1e-9 S.
    bodies : bool
        Every transistor's body is the network of resistors (50 ohm each) that its model asks for, with three nodes.
    """

    reltol: float = 1e-4
    trtol: float = 7.0
    chgtol: float = 1e-16
    abstol: float = 1e-12
    method: str = "trap"
    step: float = 10e-9
    gmin: float = 1e-15
    bodies: bool = False

    def __post_init__(self) -> None:
        check_real("reltol", self.reltol, 1e-8, 0.1)
        check_real("trtol", self.trtol, 0.1, 100)
        check_real("chgtol", self.chgtol, 1e-20, 1e-12)
        check_real("abstol", self.abstol, 1e-20, 1e-12)
        check_choice("method", self.method, METHODS)
        check_real("step", self.step, 1e-12, 1e-6)
        check_real("gmin", self.gmin, 1e-16, 1e-9)

    def cards(self, lines: Iterable[str]) -> list[str]:
        """Return the models' lines, as `bodies` asks."""
        return [line if self.bodies else BODIES.sub("rbodymod = 0", line) for line in lines]

    @property
    def options(self) -> list[str]:
        """The .option lines of a deck."""
        return [
            f".option reltol={self.reltol:g} trtol={self.trtol:g} method={self.method} gmin={self.gmin:g}",
            f".option abstol={self.abstol:g} chgtol={self.chgtol:g} itl1=300 itl2=200 itl4=100",
        ]

    @property
    def ladder(self) -> "tuple[Accuracy, ...]":
        """These, then for retries: Gear's method; also looser tolerances; also a greater gmin."""
        gear = replace(self, method="gear")
        loose = replace(gear, reltol=max(self.reltol, 5e-3), chgtol=1e-14)
        return self, gear, loose, replace(loose, gmin=1e-12)
