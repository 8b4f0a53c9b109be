"""The measurements of a datasheet."""

from dataclasses import dataclass

from .comparator import Decisions, Noise
from .lane import LaneResult


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
