"""Proc: an RV32I processor with val/rdy memory ports."""

from talbot.rtl.proc.proc_cl import ProcCL
from talbot.rtl.proc.proc_fl import ProcFL
from talbot.rtl.proc.proc_rtl import Proc

__all__ = ["Proc", "ProcCL", "ProcFL"]
