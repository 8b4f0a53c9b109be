"""Range checks of all parameter classes: one message form, one exception."""

import math
from collections.abc import Collection
from numbers import Integral, Real


class ParameterError(ValueError):
    """A parameter, option or input is out of its range.

    The message names the field, the value and the allowed range on one line.
    """


def check_int(field: str, value: object, low: int, high: int) -> None:
    """Check that a value is an integer in a range.

    field: name in the message. value: checked value; bool is not accepted. low, high: allowed range, both ends
    included. Raises ParameterError for any other value.
    """
    if isinstance(value, bool) or not isinstance(value, Integral) or not low <= int(value) <= high:
        raise ParameterError(f"{field} = {value!r}: must be an integer in {low}..{high}")


def check_real(field: str, value: object, low: float, high: float, unit: str = "") -> None:
    """Check that a value is a finite real number in a range.

    field: name in the message. value: checked value; bool is not accepted. low, high: allowed range, both ends
    included. unit: of the value, behind the range in the message; none by default. Raises ParameterError for any other
    value.
    """
    if (
        isinstance(value, bool)
        or not isinstance(value, Real)
        or not math.isfinite(value)
        or value < low
        or not value <= high
    ):
        raise ParameterError(f"{field} = {value!r}: must be a number in [{low}, {high}]{unit and f' {unit}'}")


def check_choice(field: str, value: object, allowed: Collection[object]) -> None:
    """Check that a value is one of a few.

    field: name in the message. value: checked value. allowed: all allowed values, in the order of the message. Raises
    ParameterError for any other value.
    """
    if value not in allowed:
        raise ParameterError(f"{field} = {value!r}: must be one of {', '.join(map(str, allowed))}")
