"""EdgeAdc's ports, the same at every level (README.md)."""

from pymtl3 import Bits7, Bits8, InPort, OutPort
from pymtl3.stdlib.stream.ifcs import SendIfcRTL


def declare_ports(s) -> None:
    """Give the component ``s`` its ports."""
    s.go = InPort()
    s.unsigned_ = InPort()
    s.threshold = InPort(Bits7)
    s.ternary = InPort()
    s.comparator = InPort()
    s.dac = OutPort(Bits8)
    s.free = OutPort()
    s.busy = OutPort()
    s.out = SendIfcRTL(Bits8)
    s.converted = OutPort()
