"""The analog front end: trimmed difference amplifier, sample-and-hold, DAC and comparator of every lane.

The same arithmetic is in real-number Verilog in pixels/afe.sv; both agree sample for sample.
"""

from .converter import Converter
from .files import sample_words, write_converter, write_samples
from .front_end import FrontEnd
from .noise import KTC_DECISION, NOISE_SCALE, noise_counts
from .trim import TRIM_BITS, trim_codes, trim_gain

__all__ = [
    "KTC_DECISION",
    "NOISE_SCALE",
    "TRIM_BITS",
    "Converter",
    "FrontEnd",
    "noise_counts",
    "sample_words",
    "trim_codes",
    "trim_gain",
    "write_converter",
    "write_samples",
]
