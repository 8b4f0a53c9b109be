"""TestChip1: the processor with memory, a sorter and a port for a host."""

from talbot.rtl.test_chip_1.sorter_rtl import Sorter
from talbot.rtl.test_chip_1.test_chip_1_fl import TestChip1FL
from talbot.rtl.test_chip_1.test_chip_1_rtl import TestChip1

__all__ = ["Sorter", "TestChip1", "TestChip1FL"]
