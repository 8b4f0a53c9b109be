"""The ports of a block during its tests, recorded once and replayed into any Verilog of the block."""

from .record import RecordError, record, tests_of, whole_level
from .replay import Mismatch, replay, replay_files
from .trace import Trace, load

__all__ = ["Mismatch", "RecordError", "Trace", "load", "record", "replay", "replay_files", "tests_of", "whole_level"]
