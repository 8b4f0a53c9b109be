"""ReadoutSeq: ASP readout sequencing."""

from talbot.rtl.readout_seq.readout_seq_cl import ReadoutSeqCL
from talbot.rtl.readout_seq.readout_seq_fl import ReadoutSeqFL
from talbot.rtl.readout_seq.readout_seq_rtl import ReadoutSeq

__all__ = ["ReadoutSeq", "ReadoutSeqCL", "ReadoutSeqFL"]
