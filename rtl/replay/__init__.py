"""The ports of a block during its tests, recorded once and replayed into any Verilog of the block."""

from talbot.rtl.replay.record import RecordError, record, tests_of, whole_level
from talbot.rtl.replay.replay import Mismatch, replay, replay_files
from talbot.rtl.replay.trace import Trace, load

__all__ = ["Mismatch", "RecordError", "Trace", "load", "record", "replay", "replay_files", "tests_of", "whole_level"]
