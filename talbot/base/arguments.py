"""Numbers from text of the command line. Every error names the field, the value and the range."""

from argparse import ArgumentParser, Namespace
from dataclasses import dataclass
from typing import Any

from talbot.models.parameters import ParameterError


@dataclass(frozen=True)
class Number:
    """A numeric option: its help and its check come from this one declaration.

    field: name in the options and in errors. about: what it is, for the help. low, high: range, both included.
    default: as it is typed; '' where the option may be left out. word: accepted instead of a number, for None.
    note: what the help says of the default, where that is not ``default``. kind: int or float.
    """

    field: str
    about: str
    low: float
    high: float
    default: str = ""
    word: str = ""
    note: str = ""
    kind: type[int] | type[float] = int

    def add(self, parser: ArgumentParser) -> None:
        """Add the option to ``parser``; its text is checked by `value`."""
        note = f" (default: {self.note})" if self.note else ""
        words = f"{self.about}, {self.low:.10g}..{self.high:.10g}{note}"
        parser.add_argument(f"--{self.field.replace('_', '-')}", default=self.default or None, help=words)

    def value(self, options: Namespace) -> Any:
        """Return the number in ``options``, None for ``word`` or nothing. Raises ParameterError."""
        text = getattr(options, self.field)
        if text is None or text == (self.word or None):
            return None
        if self.kind is int:
            return integer(self.field, text, int(self.low), int(self.high), also=self.word and f" or {self.word}")
        return real(self.field, text, self.low, self.high)


def span(field: str, text: str, low: int, high: int) -> tuple[int, int]:
    """Two integers 'a:b' (or one, 'a'), each in low..high, not inverted."""
    first, colon, last = text.partition(":")
    a = integer(field, first, low, high)
    b = integer(field, last, low, high) if colon else a
    if a > b:
        raise ParameterError(f"{field} = {text!r}: must not be inverted, {low} <= first <= last <= {high}")
    return a, b


def real(field: str, text: str, low: float, high: float) -> float:
    """Return a number in [low, high]."""
    value = number_of(text)
    if not isinstance(value, float) or not low <= value <= high:
        raise ParameterError(f"{field} = {text!r}: must be a number in [{low}, {high}]")
    return value


def number_of(text: str) -> float | str:
    """Return a number; ``text`` itself where it is none, for a check that names it."""
    try:
        return float(_plain(text))
    except ValueError:
        return text


def whole_of(text: str) -> int | str:
    """Return an integer; ``text`` itself where it is none, for a check that names it."""
    try:
        return int(_plain(text))
    except ValueError:
        return text


def _plain(text: str) -> str:
    """Return ``text``. Raises ValueError for what Python alone reads as a number: 1_000, digits of other scripts."""
    if "_" in text or not text.isascii():
        raise ValueError(text)
    return text


def integer(field: str, text: str, low: int, high: int, base: int = 10, also: str = "") -> int:
    """Return an integer in low..high; also: what else the field may be, for the error."""
    try:
        value = int(_plain(text), base)
    except ValueError:
        value = None
    if value is None or not low <= value <= high:
        raise ParameterError(f"{field} = {text!r}: must be an integer in {low}..{high}{also}")
    return value
