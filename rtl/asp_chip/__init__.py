"""AspChip: the whole digital chip."""

from talbot.rtl.asp_chip.asp_chip_fl import AspChipFL
from talbot.rtl.asp_chip.asp_chip_rtl import AspChip

__all__ = ["AspChip", "AspChipFL"]
