"""Ports of TestChip1 and of its sorter, the same at every level (README.md)."""

from pymtl3 import Bits8, Bits12, Bits32, OutPort, mk_bitstruct
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import MemReq

SortReq = mk_bitstruct("SortReq", {"length": Bits12, "address": Bits12})  # both in words


def declare_sorter_ports(s):
    """Declare the ports of Sorter on the component ``s``."""
    s.req = RecvIfcRTL(SortReq)
    s.resp = SendIfcRTL(Bits12)  # the length, when its words are sorted
    s.mem_req = SendIfcRTL(MemReq)
    s.mem_resp = RecvIfcRTL(Bits32)


def declare_chip_ports(s):
    """Declare the pins of TestChip1 on the component ``s``."""
    s.host2chip = RecvIfcRTL(Bits8)
    s.chip2host = SendIfcRTL(Bits8)
    s.word_waits = OutPort()  # of the processor, for the host
    s.halted = OutPort()
