"""Validated values from text of the command line. Every error names the field, the value and the range."""

import os
from argparse import ArgumentParser, Namespace
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from talbot.models.parameters import ALL_TYPES, ParameterError, Window

BETAS = {"low": 0x0000FF, "mid": 0x00FF00, "high": 0xFF0000}
TYPE_GROUPS = {"all": ALL_TYPES, **BETAS, "cosine": 0x555555, "sine": 0xAAAAAA}


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
        if text is None or text == self.word:
            return None
        if self.kind is int:
            return integer(self.field, text, int(self.low), int(self.high), also=self.word and f" or {self.word}")
        return real(self.field, text, self.low, self.high)


def pixel_types(text: str) -> int:
    """Mask of pixel types from '0xFF00FF', group names ('low,high') or type numbers ('0,2,5')."""
    mask = 0
    for word in text.split(","):
        word = word.strip().lower()
        if word in TYPE_GROUPS:
            mask |= TYPE_GROUPS[word]
        elif word.startswith("0x"):
            mask |= integer("types", word, 1, ALL_TYPES, base=16)
        else:
            mask |= 1 << integer("types", word, 0, 23, also=f", 0x<mask> or one of {', '.join(TYPE_GROUPS)}")
    return mask


def window(text: str, full: Window) -> Window:
    """Window in tiles from 'row0:row1,col0:col1', inclusive; 'full' or '' is the whole array."""
    if text in ("", "full"):
        return full
    rows, comma, cols = text.partition(",")
    if not comma:
        raise ParameterError(f"window = {text!r}: must be row0:row1,col0:col1 in tiles, inclusive")
    row0, row1 = span("window rows", rows, 0, full.row1)
    col0, col1 = span("window cols", cols, 0, full.col1)
    return Window(row0, row1, col0, col1)


def span(field: str, text: str, low: int, high: int) -> tuple[int, int]:
    """Two integers 'a:b' (or one, 'a'), each in low..high, not inverted."""
    first, colon, last = text.partition(":")
    a = integer(field, first, low, high)
    b = integer(field, last, low, high) if colon else a
    if a > b:
        raise ParameterError(f"{field} = {text!r}: must not be inverted, {low} <= first <= last <= {high}")
    return a, b


def real(field: str, text: str, low: float, high: float) -> float:
    """A number in [low, high]."""
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value <= high:
        raise ParameterError(f"{field} = {text!r}: must be a number in [{low}, {high}]")
    return value


def integer(field: str, text: str, low: int, high: int, base: int = 10, also: str = "") -> int:
    """An integer in low..high; also: what else the field may be, for the error."""
    try:
        value = int(text, base)
    except ValueError:
        value = None
    if value is None or not low <= value <= high:
        raise ParameterError(f"{field} = {text!r}: must be an integer in {low}..{high}{also}")
    return value


def named(scene: str) -> str:
    """The name of a scene: of its file or folder, also where that is given as ., x/.. or /."""
    return (Path(scene).stem.strip(".") and Path(scene).stem) or Path(os.path.abspath(scene)).name or "root"
