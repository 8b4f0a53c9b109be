"""LEF abstracts of cells from their GDS."""

from cells.lef.abstract import PinKind, abstract

__all__ = ["PinKind", "abstract"]
