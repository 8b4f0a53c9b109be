"""ReadoutSeq: ASP readout sequencing."""

from .readout_seq_rtl import ReadoutSeq

__all__ = ["ReadoutSeq"]
