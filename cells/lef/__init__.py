"""LEF abstracts of cells from their GDS."""

from cells.lef.abstract import Pin, abstract, header

__all__ = ["Pin", "abstract", "header"]
