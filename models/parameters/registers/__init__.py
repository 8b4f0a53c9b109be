"""The chip's registers: one SystemRDL source (asp_chip.rdl) for RTL, host and document."""

from .map import Field, RegisterMap, register_map, trim_range

__all__ = ["Field", "RegisterMap", "register_map", "trim_range"]
