"""Plan of a frame: the work that it needs of the models and the chip, and the work that it leaves out."""

from .flat import codes_per_unit, flat_tiles
from .plan import LeftOut, Plan, plan

__all__ = ["LeftOut", "Plan", "codes_per_unit", "flat_tiles", "plan"]
