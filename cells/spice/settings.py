"""Tolerances of ngspice, and what is tried when it fails."""

from dataclasses import dataclass, replace

from talbot.models.parameters import ParameterError


@dataclass(frozen=True)
class Settings:
    """Accuracy of ngspice.

    reltol, trtol: tolerances of the solution and of the time step.
    steps: fewest time points of a transient.
    timeout: CPU seconds of a transient.
    method: trap or gear.
    """

    reltol: float = 1e-3
    trtol: float = 7.0
    steps: int = 8
    timeout: float = 20.0
    method: str = "trap"

    def __post_init__(self) -> None:
        if not 1e-8 <= self.reltol <= 0.1:
            raise ParameterError(f"reltol = {self.reltol}: must be 1e-8 to 0.1")
        if not 0.1 <= self.trtol <= 100:
            raise ParameterError(f"trtol = {self.trtol}: must be 0.1 to 100")
        if not 1 <= self.steps <= 10000:
            raise ParameterError(f"steps = {self.steps}: must be 1 to 10000")
        if not self.timeout > 0:
            raise ParameterError(f"timeout = {self.timeout}: must be above 0 s")
        if self.method not in ("trap", "gear"):
            raise ParameterError(f"method = {self.method!r}: must be trap or gear")

    @property
    def options(self) -> list[str]:
        """The .option lines of a deck; gmin and abstol are below the leakage of one transistor (0.1 pA)."""
        return [
            f".option reltol={self.reltol:g} trtol={self.trtol:g} method={self.method} gmin=1e-15 abstol=1e-15",
            ".option chgtol=1e-17 itl1=300 itl2=200 itl4=100",
        ]

    @property
    def retries(self) -> "tuple[Settings, ...]":
        """The settings of the retries, in order.

        Looser tolerances where these are tight; Gear's method; then the usual tolerances and more time, too.
        """
        looser = 5 * self.reltol
        return (
            *([replace(self, reltol=looser)] if looser <= 1e-3 else []),
            replace(self, method="gear"),
            replace(self, method="gear", reltol=max(self.reltol, 1e-3), trtol=7.0, timeout=3 * self.timeout),
        )
