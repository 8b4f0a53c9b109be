"""AmpCtrl: the pixel amplifier's control FSM."""

from .amp_ctrl_rtl import AmpCtrl

__all__ = ["AmpCtrl"]
