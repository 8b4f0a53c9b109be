"""AmpCtrl: the pixel amplifier's control FSM."""

from .amp_ctrl_fl import AmpCtrlFL
from .amp_ctrl_rtl import AmpCtrl

__all__ = ["AmpCtrl", "AmpCtrlFL"]
