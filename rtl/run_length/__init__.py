"""RunLength: the encoder between the scan and the link."""

from .run_length_cl import RunLengthCL
from .run_length_fl import RunLengthFL
from .run_length_rtl import RunLength

__all__ = ["RunLength", "RunLengthCL", "RunLengthFL"]
