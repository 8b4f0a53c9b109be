"""Figures as text."""

from typing import Any

NOT_RUN = "not run"


def as_text(value: Any, words: tuple[str, str] = ("yes", "no")) -> str:
    """Format a figure: thousands with commas, NOT_RUN for None, ``words`` for true and false."""
    if isinstance(value, bool):
        return words[not value]
    return NOT_RUN if value is None else f"{value:,}" if isinstance(value, (int, float)) else str(value)
