"""The measurements of a datasheet."""

from dataclasses import dataclass

from talbot.pixels.datasheet.amplifier import AmplifierResult
from talbot.pixels.datasheet.column import ColumnResult
from talbot.pixels.datasheet.comparator import Decisions
from talbot.pixels.datasheet.curves import ColumnFit
from talbot.pixels.datasheet.interface import InterfaceResult
from talbot.pixels.datasheet.lane import LaneResult
from talbot.pixels.datasheet.noise import Noise
from talbot.pixels.datasheet.references import ReferencesResult
from talbot.pixels.datasheet.row_driver import RowDriverResult
from talbot.pixels.datasheet.spread import AmplifierNoise, Drawn
from talbot.pixels.datasheet.supply import Ripple
from talbot.pixels.datasheet.support import SupportResult
from talbot.pixels.datasheet.turn import TurnResult

TYPICAL = "tt_027C_1v80"  # the corner of typical values


@dataclass(frozen=True)
class Found:
    """Measurements by corner."""

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
    ripples: dict[str, Ripple]
    supports: dict[str, SupportResult]
    rows: dict[str, RowDriverResult]
    columns: dict[str, ColumnResult]
    column_noise: dict[str, float]
    column_offsets: list[float]
    pixel_offsets: list[float]
    turns: dict[str, TurnResult]
    column_fit: ColumnFit | None  # None where nothing needs it
    interfaces: dict[str, InterfaceResult]
    references: dict[str, ReferencesResult]
