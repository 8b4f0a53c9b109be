"""RunLength's ports, the same at every level (README.md)."""

from pymtl3 import Bits2, Bits3, Bits7, Bits8, Bits10, Bits16, Bits24, Bits32, InPort, OutPort
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.models.parameters import MODES
from talbot.rtl.messages import ScanMsg

TERNARY = MODES.index("ternary")

HEADER_PORTS = {
    "mode": Bits3,
    "phase": None,
    "row0": Bits8,
    "row1": Bits8,
    "col0": Bits8,
    "col1": Bits8,
    "decimation": Bits2,
    "mask": Bits24,
    "threshold": Bits7,
    "frame_number": Bits16,
    "resync": Bits2,
    "exposure": Bits10,
    "n_cm": Bits8,
    "t_int": Bits16,
    "calibration": Bits8,
}


def declare_header_ports(s) -> None:
    """Give the component ``s`` ports for the configuration in the header; held from FRAME to the end of the frame."""
    for name, kind in HEADER_PORTS.items():
        setattr(s, name, InPort(kind) if kind else InPort())


def declare_ports(s) -> None:
    """Give the component ``s`` its ports."""
    s.recv = RecvIfcRTL(ScanMsg)
    declare_header_ports(s)
    s.made = InPort(Bits32)
    s.left_out = InPort(Bits32)
    s.send = SendIfcRTL(Bits8)
    s.frame_sync = OutPort()
    s.state = OutPort(3)  # of the control, for a host that looks for the cause of a stop; 0 at FL and CL
