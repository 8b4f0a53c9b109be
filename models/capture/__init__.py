"""From the light field to the samples that the analog front end converts."""

from .expose import Exposure, expose
from .frame import capture
from .operator import CaptureOperator
from .ratio import capture_ratio

__all__ = ["CaptureOperator", "Exposure", "capture", "capture_ratio", "expose"]
