"""RunLength: the encoder between the scan and the link."""

from talbot.rtl.run_length.run_length_cl import RunLengthCL
from talbot.rtl.run_length.run_length_fl import RunLengthFL
from talbot.rtl.run_length.run_length_rtl import RunLength

__all__ = ["RunLength", "RunLengthCL", "RunLengthFL"]
