"""A block of the die that is drawn: what LVS, the die and `make analog-layout` ask of each."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from talbot.base.gds import db
from talbot.pixels.blocks import AnalogSizes, Block
from talbot.pixels.footprints import lef
from talbot.platforms.analog import AnalogMasks


@dataclass(frozen=True)
class DrawnBlock(ABC):
    """The drawn block. boxes: cells that LVS compares once, and their instances by their pins."""

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
        """Its text for LVS; pins that it does not use are none of its ports."""

    def lef(self, masks: AnalogMasks) -> str:
        """Its LEF: all metals taken."""
        return lef(self.block, masks.base.name, AnalogSizes().supply_um, [metal.lef for metal in masks.base.metals])
