"""The chip's registers: one SystemRDL source (asp_chip.rdl) for RTL, host and document."""

from talbot.models.parameters.registers.map import Field, RegisterMap, array_resets, register_map, trim_range

__all__ = ["Field", "RegisterMap", "array_resets", "register_map", "trim_range"]
