"""AmpCtrl: the pixel amplifier's control FSM."""

from talbot.rtl.amp_ctrl.amp_ctrl_fl import AmpCtrlFL
from talbot.rtl.amp_ctrl.amp_ctrl_rtl import AmpCtrl

__all__ = ["AmpCtrl", "AmpCtrlFL"]
