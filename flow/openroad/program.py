"""How OpenROAD is called (`base.openroad`)."""

from talbot.base.openroad import command

__all__ = ["command"]
