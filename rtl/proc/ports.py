"""Proc's ports, the same at every level (README.md)."""

from pymtl3 import Bits32, InPort, OutPort
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import MemReq


def declare_ports(s):
    """Declare the ports of Proc on the component ``s``."""
    s.imem_req = SendIfcRTL(Bits32)  # a word's address
    s.imem_resp = RecvIfcRTL(Bits32)
    s.dmem_req = SendIfcRTL(MemReq)
    s.dmem_resp = RecvIfcRTL(Bits32)
    s.from_manager = RecvIfcRTL(Bits32)
    s.to_manager = SendIfcRTL(Bits32)
    s.hart_id = InPort(32)
    s.halted = OutPort()  # until reset
