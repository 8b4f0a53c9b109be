"""The measurements of a datasheet."""

from dataclasses import dataclass

from .amplifier import AmplifierResult
from .column import ColumnResult
from .comparator import Decisions
from .curves import ColumnFit
from .lane import LaneResult
from .noise import Noise
from .row_driver import RowDriverResult
from .spread import AmplifierNoise, Drawn
from .support import SupportResult
from .turn import TurnResult

TYPICAL = "tt_027C_1v80"  # the corner of typical values


@dataclass(frozen=True)
class Found:
    """What was measured, by corner name."""

    decisions: dict[str, Decisions]
    lanes: dict[str, LaneResult]
    offsets: list[float]
    noise: Noise
    inl: list[float]
    dnl: list[float]
    enob: list[float]
    ktc: dict[str, float]
    amplifiers: dict[str, AmplifierResult]
    amplifier_ktc: dict[str, float]
    amplifier_draws: list[Drawn]
    amplifier_noise: AmplifierNoise
    supports: dict[str, SupportResult]
    rows: dict[str, RowDriverResult]
    columns: dict[str, ColumnResult]
    column_noise: dict[str, float]
    column_offsets: list[float]
    pixel_offsets: list[float]
    turns: dict[str, TurnResult]
    column_fit: ColumnFit
