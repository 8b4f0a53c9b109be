"""The measurements of a datasheet."""

from dataclasses import dataclass

from talbot.flow.analog.amplifier import AmplifierResult
from talbot.flow.analog.column import ColumnResult
from talbot.flow.analog.comparator import Decisions
from talbot.flow.analog.curves import ColumnFit
from talbot.flow.analog.lane import LaneResult
from talbot.flow.analog.noise import Noise
from talbot.flow.analog.row_driver import RowDriverResult
from talbot.flow.analog.spread import AmplifierNoise, Drawn
from talbot.flow.analog.support import SupportResult
from talbot.flow.analog.turn import TurnResult

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
