"""A drawn block of the die: the interface for LVS, the die and `make analog-layout`."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from talbot.base.gds import db
from talbot.pixels.blocks import AnalogSizes, Block
from talbot.pixels.footprints import lef
from talbot.platforms.analog import AnalogMasks


@dataclass(frozen=True)
class DrawnBlock(ABC):
    """The drawn block. boxes: cells that LVS compares separately; instances are compared by pins."""

    boxes: ClassVar[tuple[str, ...]] = ()

    block: Block
    layout: "db.Layout"
    cell: "db.Cell"

    @property
    @abstractmethod
    def count(self) -> int:
        """Transistors."""

    @abstractmethod
    def spice(self, masks: AnalogMasks) -> str:
        """Netlist for LVS; unused pins are no ports."""

    def lef(self, masks: AnalogMasks) -> str:
        """LEF of the block: all metals are obstructed."""
        return lef(self.block, masks.base.name, AnalogSizes().supply_um, [metal.lef for metal in masks.base.metals])
