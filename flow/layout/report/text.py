"""Figures as text."""

from typing import Any


def as_text(value: Any, words: tuple[str, str] = ("yes", "no")) -> str:
    """Format a figure: thousands with commas, '-' for None, ``words`` for true and false."""
    if isinstance(value, bool):
        return words[not value]
    return "-" if value is None else f"{value:,}" if isinstance(value, (int, float)) else str(value)
