"""Range checks shared by every parameter class: one message form, one exception."""

import math
from numbers import Integral, Real


class ParameterError(ValueError):
    """A parameter, option or input is out of its range.

    The message names the field, the value and the allowed range on one line.
    """


def check_int(field, value, low, high):
    """Raise ParameterError unless ``value`` is an integer in ``low..high``."""
    if isinstance(value, bool) or not isinstance(value, Integral) or not low <= value <= high:
        raise ParameterError(f"{field} = {value!r}: must be an integer in {low}..{high}")


def check_real(field, value, low, high):
    """Raise ParameterError unless ``value`` is a finite real number in ``[low, high]``."""
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value) or not low <= value <= high:
        raise ParameterError(f"{field} = {value!r}: must be a number in [{low}, {high}]")


def check_choice(field, value, allowed):
    """Raise ParameterError unless ``value`` is one of ``allowed``."""
    if value not in allowed:
        raise ParameterError(f"{field} = {value!r}: must be one of {', '.join(map(str, allowed))}")
