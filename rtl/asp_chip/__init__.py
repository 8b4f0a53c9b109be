"""AspChip: the whole digital chip."""

from .asp_chip_fl import AspChipFL
from .asp_chip_rtl import AspChip

__all__ = ["AspChip", "AspChipFL"]
