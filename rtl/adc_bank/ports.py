"""AdcBank's ports, the same at every level (README.md)."""

from pymtl3 import Bits2, Bits3, Bits7, Bits8, Bits10, Bits32, InPort, OutPort, mk_bits
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.models.parameters import MODES
from talbot.rtl.messages import ScanMsg, step_msg

TERNARY = MODES.index("ternary")


def declare_ports(s, lanes: int) -> None:
    """Give the component ``s`` its ports."""
    s.step = RecvIfcRTL(step_msg(lanes))
    s.mode = InPort(Bits3)
    s.threshold = InPort(Bits7)
    s.comparator = InPort(lanes)
    s.dac = OutPort(mk_bits(8 * lanes))
    s.hold = OutPort()
    s.wake = OutPort()
    s.row = OutPort(Bits10)
    s.group = OutPort(Bits8)
    s.k = OutPort(Bits3)
    s.sub = OutPort(Bits2)
    s.en = OutPort(lanes)
    s.unsigned_ = OutPort()
    s.idle = OutPort()
    s.made = OutPort(Bits32)
    s.left_out = OutPort(Bits32)
    s.scan = SendIfcRTL(ScanMsg)
