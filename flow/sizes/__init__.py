"""Cells and gate equivalents of every block: Yosys with the abstract library cells/gates.lib."""

from .measure import Size, measure
from .table import markdown

__all__ = ["Size", "markdown", "measure"]
