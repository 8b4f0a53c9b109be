"""The call of OpenROAD (`base.openroad`)."""

from talbot.base.openroad import command

__all__ = ["command"]
