"""The analog front end: trimmed difference amplifier, sample-and-hold, DAC and comparator of every lane.

The same arithmetic is in real-number Verilog in pixels/afe.sv; both agree sample for sample.
"""

from talbot.models.afe.converter import Converter
from talbot.models.afe.files import sample_words, write_converter, write_samples
from talbot.models.afe.front_end import FrontEnd
from talbot.models.afe.noise import KTC_DECISION, NOISE_SCALE, noise_counts
from talbot.models.afe.trim import TRIM_BITS, trim_codes, trim_gain

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
