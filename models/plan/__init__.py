"""Plan of a frame: the work that it needs of the models and the chip, and the work that it leaves out."""

from talbot.models.plan.codes import codes_per_unit
from talbot.models.plan.plan import LeftOut, Plan, plan

__all__ = ["LeftOut", "Plan", "codes_per_unit", "plan"]
