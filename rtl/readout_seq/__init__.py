"""ReadoutSeq: ASP readout sequencing."""

from .readout_seq_cl import ReadoutSeqCL
from .readout_seq_fl import ReadoutSeqFL
from .readout_seq_rtl import ReadoutSeq

__all__ = ["ReadoutSeq", "ReadoutSeqCL", "ReadoutSeqFL"]
