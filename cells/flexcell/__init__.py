"""The cell library of the embedded layout backend: drawn from transistor lists, on c4m-pdk-sky130's rules."""

from cells.flexcell.canvas import Canvas
from cells.flexcell.library import library

__all__ = ["Canvas", "library"]
