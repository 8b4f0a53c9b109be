"""Validated values from text of the command line. Every error names the field, the value and the range."""

import os
from pathlib import Path

from talbot.base.arguments import integer, span
from talbot.models.parameters import ALL_TYPES, ParameterError, Window

BETAS = {"low": 0x0000FF, "mid": 0x00FF00, "high": 0xFF0000}
TYPE_GROUPS = {"all": ALL_TYPES, **BETAS, "cosine": 0x555555, "sine": 0xAAAAAA}


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


def named(scene: str) -> str:
    """Return the name of a scene: of its file or folder, also where that is given as ., x/.. or /."""
    return (Path(scene).stem.strip(".") and Path(scene).stem) or Path(os.path.abspath(scene)).name or "root"
