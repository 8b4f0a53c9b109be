"""The conditions of a characterization: every parameter that decides a result."""

from dataclasses import dataclass, field

from talbot.cells.corner import Corner
from talbot.cells.spice.settings import Settings
from talbot.models.parameters import ParameterError

LOW_SUPPLY = 1.7  # V, below which SkyWater's tables of the slow process run to 5 ns
SLEWS = (
    (0.01e-9, 0.0230506e-9, 0.0531329e-9, 0.122474e-9, 0.282311e-9, 0.650743e-9, 1.5e-9),
    (0.01e-9, 0.0281727e-9, 0.0793701e-9, 0.223607e-9, 0.629961e-9, 1.77477e-9, 5e-9),
)
CONSTRAINT_SLEWS = (0.01e-9, 0.5e-9, 1.5e-9), (0.01e-9, 0.5e-9, 2.5e-9, 5e-9)


@dataclass(frozen=True)
class Conditions:
    """The conditions of a characterization; thresholds are fractions of the supply, times s, loads F.

    corner: process, temperature and voltage.
    models: device models, one of the process's `SETS`.
    lower, upper: thresholds of slews, SkyWater's 20 % and 80 % without derating.
    middle: threshold of delays.
    slews: input slews of a table, ascending; empty: SkyWater's, to 5 ns where a slow process has a low supply, else to
        1.5 ns.
    loads: points of the load axis, which ends where the output's slew is the last of ``slews``.
    least_load: first point of the load axis.
    longest_slew: the limit (max_transition) at which an output has its largest load (max_capacitance).
    constraint_slews: slews of setup and hold tables.
    degrade: share by which the clock-to-output delay may grow at the least setup or hold time.
    states: most states over which an input's capacitance is averaged.
    bend: error of an interpolated value above which a point is added.
    extra: most points that are added.
    settings: tolerances of ngspice.
    """

    corner: Corner
    models: str = "binned"
    lower: float = 0.2
    upper: float = 0.8
    middle: float = 0.5
    slews: tuple[float, ...] = ()
    loads: int = 7
    least_load: float = 0.5e-15
    longest_slew: float = 1.5e-9
    constraint_slews: tuple[float, ...] = ()
    degrade: float = 0.1
    states: int = 4
    bend: float = 0.015
    extra: int = 6
    settings: Settings = field(default_factory=lambda: Settings(reltol=1e-4, method="gear", steps=50))

    def __post_init__(self) -> None:
        slow = self.corner.process == "ss" and self.corner.supply < LOW_SUPPLY
        for name, default in (("slews", SLEWS), ("constraint_slews", CONSTRAINT_SLEWS)):
            object.__setattr__(self, name, getattr(self, name) or default[slow])
        object.__setattr__(self, "longest_slew", min(self.longest_slew, max(self.slews)))
        if not 0 < self.lower < self.middle < self.upper < 1:
            raise ParameterError("thresholds = lower, middle, upper: must rise between 0 and 1")
        for name in ("slews", "constraint_slews"):
            values = getattr(self, name)
            if not values or list(values) != sorted(set(values)) or values[0] <= 0:
                raise ParameterError(f"{name} = {values}: must be above 0 and rise")
        if self.loads < 2:
            raise ParameterError(f"loads = {self.loads}: must be 2 or more")
        if self.extra < 0 or self.bend <= 0:
            raise ParameterError(f"extra, bend = {self.extra}, {self.bend}: must be 0 or more, above 0")
        if not 0 < self.degrade < 1:
            raise ParameterError(f"degrade = {self.degrade}: must be between 0 and 1")

    @property
    def fastest(self) -> bool:
        """Whether a table is that of the arc's fastest state (ff, as SkyWater's) instead of its slowest."""
        return self.corner.process == "ff"

    @property
    def middle_slew(self) -> float:
        """The slew in the middle of the table's axis."""
        return self.slews[len(self.slews) // 2]

    def ramp(self, slew: float) -> float:
        """Length in s of the whole ramp, 0 to 100 %, whose slew is ``slew`` s."""
        return slew / (self.upper - self.lower)
