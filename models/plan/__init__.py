"""What a frame needs of the models and the chip, and what it leaves out."""

from .flat import codes_per_unit, flat_tiles
from .plan import Plan, plan

__all__ = ["Plan", "codes_per_unit", "flat_tiles", "plan"]
